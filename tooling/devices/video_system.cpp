// SPDX-License-Identifier: Apache-2.0
#include "tooling/devices/video_system.hpp"

#include <cerrno>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace stillmap {
namespace {

class LinuxVideo : public VideoSystem {
 public:
  // NOLINTBEGIN(cppcoreguidelines-pro-type-vararg): the system's calls are such.
  [[nodiscard]] int open(const std::string& path) override {
    return ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  }
  void close(int descriptor) override { ::close(descriptor); }
  [[nodiscard]] int control(int descriptor, std::uint64_t request, void* argument) override {
    int result = 0;
    do {
      result = ::ioctl(descriptor, request, argument);
    } while (result == -1 && errno == EINTR);
    return result;
  }
  // NOLINTEND(cppcoreguidelines-pro-type-vararg)
  [[nodiscard]] void* map(int descriptor, std::size_t bytes, std::int64_t offset) override {
    void* const memory =
        ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t bytes) override { ::munmap(memory, bytes); }
  [[nodiscard]] int poll(std::span<pollfd> descriptors, int timeout_ms) override {
    return ::poll(descriptors.data(), descriptors.size(), timeout_ms);
  }
};

}  // namespace

VideoSystem& linux_video() {
  static LinuxVideo system;
  return system;
}

}  // namespace stillmap
