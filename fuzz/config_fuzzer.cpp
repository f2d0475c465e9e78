// SPDX-License-Identifier: Apache-2.0
// Any bytes are read as settings or refused; what is read is written and read again.
#include "fuzz/harness.hpp"
#include "stillmap/config/config_io.hpp"
#include "tests/support/sample_config.hpp"

namespace stillmap::fuzz {
namespace {

void read(std::string_view bytes) {
  test::Config config;
  const std::vector<FieldRef> fields = list_fields(config);
  read_or_refuse([&] {
    load_yaml_text(fields, bytes, "input");
    test::Config again;
    const std::vector<FieldRef> fields_again = list_fields(again);
    load_yaml_text(fields_again, dump_yaml(fields), "what was written");
    require(dump_yaml(fields_again) == dump_yaml(fields), "the same settings");
  });
  test::Config of_another_version;
  read_or_refuse(
      [&] { load_yaml_text(list_fields(of_another_version), bytes, "input", UnknownKeys::kSkip); });
  read_or_refuse([&] { set_value(fields, bytes, "--set"); });
}

}  // namespace
}  // namespace stillmap::fuzz

STILLMAP_FUZZER(stillmap::fuzz::read)
