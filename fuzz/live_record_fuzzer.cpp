// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as the record of a live run or refused; what is read is written and read
// again.
#include "fuzz/harness.hpp"
#include "tooling/pipeline/live_record.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  static const MemoryFolder folder;
  const std::filesystem::path file = folder.put("live.jsonl", bytes);
  read_or_refuse([&] {
    const LiveRecord record = read_live_record(file);
    require(!record.empty(), "there are frames");
    require(read_live_record(folder.put("again.jsonl", live_jsonl(record))) == record,
            "the same record");
  });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
