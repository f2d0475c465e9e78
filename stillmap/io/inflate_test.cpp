// SPDX-License-Identifier: Apache-2.0
#include "stillmap/io/inflate.hpp"

#include <random>
#include <string>

#include <gtest/gtest.h>
#include <zlib.h>

#include "stillmap/core/error.hpp"

namespace stillmap {
namespace {

struct Deflating {
  int level = 6;
  int strategy = Z_DEFAULT_STRATEGY;
};

// By zlib.
std::string deflated(const std::string& bytes, Deflating how) {
  z_stream stream = {};
  STILLMAP_CHECK(deflateInit2(&stream, how.level, Z_DEFLATED, 15, 8, how.strategy) == Z_OK);
  std::string result(deflateBound(&stream, bytes.size()), '\0');
  std::string source = bytes;
  stream.next_in = reinterpret_cast<Bytef*>(source.data());
  stream.avail_in = static_cast<uInt>(source.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  STILLMAP_CHECK(deflate(&stream, Z_FINISH) == Z_STREAM_END);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

// Nothing when zlib does not take it for a whole stream of `size` bytes.
std::optional<std::string> by_zlib(const std::string& stream, std::size_t size) {
  std::string bytes(size + 1, '\0');
  uLongf count = bytes.size();
  uLong used = stream.size();
  const int status = uncompress2(reinterpret_cast<Bytef*>(bytes.data()),
                                 &count,
                                 reinterpret_cast<const Bytef*>(stream.data()),
                                 &used);
  if (status != Z_OK || count != size || used != stream.size()) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

std::string inflated(const std::string& stream, std::size_t size) {
  const std::optional<std::vector<std::uint8_t>> bytes = inflate_whole(stream, size);
  return bytes ? std::string(bytes->begin(), bytes->end()) : "nothing";
}

// Noise of a spread, with repeats from near and far; spread 256 is incompressible.
std::string material(std::size_t size, double spread, double repeats, std::mt19937& rng) {
  std::normal_distribution<double> noise(128.0, spread);
  std::uniform_real_distribution<double> chance(0.0, 1.0);
  std::string bytes;
  while (bytes.size() < size) {
    if (!bytes.empty() && chance(rng) < repeats) {
      const std::size_t distance = 1 + rng() % std::min<std::size_t>(bytes.size(), 40000);
      const std::size_t length = 1 + rng() % 400;
      for (std::size_t i = 0; i < length; ++i) bytes += bytes[bytes.size() - distance];
    } else {
      bytes += static_cast<char>(static_cast<int>(noise(rng)));
    }
  }
  bytes.resize(size);
  return bytes;
}

TEST(InflateWhole, GivesBackWhatZlibDeflated) {
  std::mt19937 rng(1);
  for (const std::size_t size : {0, 1, 2, 7, 100, 5000, 200000}) {
    for (const double spread : {0.1, 2.0, 10.0, 1000.0}) {
      for (const double repeats : {0.0, 0.02, 0.5}) {
        const std::string bytes = material(size, spread, repeats, rng);
        for (const int level : {0, 1, 6, 9}) {
          for (const int strategy : {Z_DEFAULT_STRATEGY, Z_RLE, Z_HUFFMAN_ONLY, Z_FIXED}) {
            const std::string stream = deflated(bytes, {level, strategy});
            ASSERT_EQ(inflated(stream, size), bytes) << size << ' ' << level << ' ' << strategy;
          }
        }
      }
    }
  }
}

// Counts that grow as Fibonacci's numbers make the longest codes that there can be.
TEST(InflateWhole, KnowsLongCodes) {
  std::mt19937 rng(2);
  std::string bytes;
  std::size_t count = 1, before = 1;
  for (int symbol = 0; symbol < 20; ++symbol) {
    bytes.append(count, static_cast<char>(symbol));
    count += std::exchange(before, count);
  }
  std::shuffle(bytes.begin(), bytes.end(), rng);
  for (const int strategy : {Z_DEFAULT_STRATEGY, Z_HUFFMAN_ONLY}) {
    EXPECT_EQ(inflated(deflated(bytes, {6, strategy}), bytes.size()), bytes);
  }
}

TEST(InflateWhole, KnowsTheShortestOfStreams) {
  // By hand: one fixed block with "a" (code 0x91) and the end (seven zeros); Adler-32 of "a".
  EXPECT_EQ(inflated(std::string("\x78\x9c\x4b\x04\x00\x00\x62\x00\x62", 9), 1), "a");
}

TEST(InflateWhole, RefusesAnotherSize) {
  const std::string bytes = "abcabcabcabcabcabcabcabc, and so on";
  const std::string stream = deflated(bytes, {});
  for (std::size_t size = 0; size < 100; ++size) {
    EXPECT_EQ(inflate_whole(stream, size).has_value(), size == bytes.size()) << size;
  }
  EXPECT_FALSE(inflate_whole(stream, std::size_t{1} << 62U));  // and does not try to allocate it
}

TEST(InflateWhole, RefusesEveryTruncationAndWhatFollows) {
  std::mt19937 rng(3);
  for (const int level : {0, 1, 9}) {
    const std::string bytes = material(3000, 5.0, 0.1, rng);
    const std::string stream = deflated(bytes, {level});
    for (std::size_t size = 0; size < stream.size(); ++size) {
      ASSERT_FALSE(inflate_whole(stream.substr(0, size), bytes.size())) << size;
    }
    EXPECT_FALSE(inflate_whole(stream + '\0', bytes.size()));
  }
}

// Some bits matter to nobody, such as those behind the last block, which zlib may still refuse; and
// rarely what a changed stream says has the checksum of what it should say, which zlib takes too.
TEST(InflateWhole, OfAChangedStreamGivesTheSameOrWhatZlibGives) {
  std::mt19937 rng(4);
  for (int trial = 0; trial < 30000; ++trial) {
    const std::string bytes = material(1 + rng() % 600, 3.0, 0.1, rng);
    const int strategy = static_cast<int>(rng() % 5);
    std::string stream = deflated(bytes, {static_cast<int>(rng() % 10), strategy});
    const std::size_t at = rng() % stream.size();
    stream[at] = static_cast<char>(static_cast<unsigned>(stream[at]) ^ (1U << rng() % 8));
    const std::optional<std::vector<std::uint8_t>> taken = inflate_whole(stream, bytes.size());
    if (!taken) continue;
    const std::string found(taken->begin(), taken->end());
    ASSERT_EQ(found, by_zlib(stream, bytes.size()).value_or(bytes)) << trial;
  }
}

// What no checksum keeps from the decoder: blocks of random bits, behind a sound header.
TEST(InflateWhole, SurvivesRandomBits) {
  std::mt19937 rng(5);
  for (int trial = 0; trial < 100000; ++trial) {
    std::string stream = "\x78\x9c";
    for (std::size_t size = 4 + rng() % 200; size > 0; --size) stream += static_cast<char>(rng());
    ASSERT_FALSE(inflate_whole(stream, rng() % 1000)) << trial;
  }
}

}  // namespace
}  // namespace stillmap
