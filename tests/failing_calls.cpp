// SPDX-License-Identifier: Apache-2.0
// A library to be loaded before the others (LD_PRELOAD): lets one call to the system fail, or kills
// the process there. The calls of the program for files are counted from 1 on.
//
//   STILLMAP_FAIL_CALL=N        the N-th call fails
//   STILLMAP_KILL_CALL=N        the process is killed before the N-th call
//   STILLMAP_FAIL_ALLOCATION=N  the N-th allocation of at least 16 KiB fails
//   STILLMAP_COUNTS=FILE        at the end, the numbers of calls and of allocations are appended
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

namespace {

std::atomic<long> calls{0}, allocations{0};

long number_of(const char* variable) {
  const char* const text = std::getenv(variable);
  return text == nullptr ? 0 : std::atol(text);
}

// Read by the constructor, so that allocations need not look.
long fail_call = 0, kill_call = 0, fail_allocation = 0;
bool counting = false;  // before the constructor and after the destructor nothing counts

__attribute__((constructor)) void begin() {
  fail_call = number_of("STILLMAP_FAIL_CALL");
  kill_call = number_of("STILLMAP_KILL_CALL");
  fail_allocation = number_of("STILLMAP_FAIL_ALLOCATION");
  counting = true;
}

__attribute__((destructor)) void end() {
  counting = false;
  const char* const path = std::getenv("STILLMAP_COUNTS");
  if (path == nullptr) return;
  if (std::FILE* const file = std::fopen(path, "a")) {
    std::fprintf(file, "%ld %ld\n", calls.load(), allocations.load());
    std::fclose(file);
  }
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

bool fails(int error_number) {
  if (!counting) return false;
  const long number = ++calls;
  if (number == kill_call) ::kill(::getpid(), SIGKILL);
  if (number != fail_call) return false;
  errno = error_number;
  return true;
}

// The files of the system are none of the program's.
bool is_of_system(const char* path) {
  for (const char* folder : {"/proc", "/sys", "/usr", "/lib", "/etc", "/dev"}) {
    if (std::strncmp(path, folder, std::strlen(folder)) == 0) return true;
  }
  return false;
}

bool allocation_fails(std::size_t size) {
  constexpr std::size_t kLarge = 16384;
  return counting && size >= kLarge && ++allocations == fail_allocation;
}

}  // namespace

extern "C" {

int open(const char* path, int flags, ...) {
  va_list more;
  va_start(more, flags);
  const auto mode = (flags & O_CREAT) != 0 ? va_arg(more, mode_t) : 0;
  va_end(more);
  if (!is_of_system(path) && fails(EMFILE)) return -1;
  return next<int (*)(const char*, int, ...)>("open")(path, flags, mode);
}

ssize_t read(int fd, void* bytes, size_t size) {
  if (fails(EIO)) return -1;
  return next<ssize_t (*)(int, void*, size_t)>("read")(fd, bytes, size);
}

ssize_t pread(int fd, void* bytes, size_t size, off_t offset) {
  if (fails(EIO)) return -1;
  return next<ssize_t (*)(int, void*, size_t, off_t)>("pread")(fd, bytes, size, offset);
}

// The first half of the bytes is written, as on a disk that becomes full.
ssize_t write(int fd, const void* bytes, size_t size) {
  if (fd <= 2) return next<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size);
  if (fails(ENOSPC)) {
    (void)next<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size / 2);
    errno = ENOSPC;
    return -1;
  }
  return next<ssize_t (*)(int, const void*, size_t)>("write")(fd, bytes, size);
}

ssize_t pwrite(int fd, const void* bytes, size_t size, off_t offset) {
  if (fails(ENOSPC)) return -1;
  return next<ssize_t (*)(int, const void*, size_t, off_t)>("pwrite")(fd, bytes, size, offset);
}

int fsync(int fd) {
  return fails(EIO) ? -1 : next<int (*)(int)>("fsync")(fd);
}

int syncfs(int fd) noexcept {
  return fails(EIO) ? -1 : next<int (*)(int)>("syncfs")(fd);
}

int rename(const char* from, const char* to) noexcept {
  return fails(EIO) ? -1 : next<int (*)(const char*, const char*)>("rename")(from, to);
}

int renameat2(
    int from_folder, const char* from, int to_folder, const char* to, unsigned flags) noexcept {
  if (fails(EIO)) return -1;
  return next<int (*)(int, const char*, int, const char*, unsigned)>("renameat2")(
      from_folder, from, to_folder, to, flags);
}

int link(const char* from, const char* to) noexcept {
  return fails(EMLINK) ? -1 : next<int (*)(const char*, const char*)>("link")(from, to);
}

int mkdir(const char* path, mode_t mode) noexcept {
  return fails(ENOSPC) ? -1 : next<int (*)(const char*, mode_t)>("mkdir")(path, mode);
}

int unlink(const char* path) noexcept {
  return fails(EIO) ? -1 : next<int (*)(const char*)>("unlink")(path);
}

int rmdir(const char* path) noexcept {
  return fails(EIO) ? -1 : next<int (*)(const char*)>("rmdir")(path);
}

// What the C library itself calls; dlsym() would allocate.
void* __libc_malloc(size_t size);
void* __libc_memalign(size_t alignment, size_t size);

void* malloc(size_t size) noexcept {
  if (!allocation_fails(size)) return __libc_malloc(size);
  errno = ENOMEM;
  return nullptr;
}

int posix_memalign(void** target, size_t alignment, size_t size) noexcept {
  if (allocation_fails(size)) return ENOMEM;
  *target = __libc_memalign(alignment, size);
  return *target == nullptr ? ENOMEM : 0;
}

}  // extern "C"
