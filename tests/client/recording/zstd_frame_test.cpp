#include "telltale/client/recording/zstd_frame.hpp"

#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

namespace telltale {
namespace {

using Bytes = std::vector<std::uint8_t>;

// RFC 8878: the magic number, a header of one segment with a content size of four bytes, and the
// last block, raw.
Bytes FrameThatStates(std::uint32_t size, const Bytes& content) {
  Bytes frame{0x28, 0xB5, 0x2F, 0xFD, 0xA0};
  for (int shift = 0; shift < 32; shift += 8) {
    frame.push_back(static_cast<std::uint8_t>(size >> shift));
  }
  const auto header = static_cast<std::uint32_t>(content.size() << 3 | 1);
  for (int shift = 0; shift < 24; shift += 8) {
    frame.push_back(static_cast<std::uint8_t>(header >> shift));
  }
  frame.insert(frame.end(), content.begin(), content.end());
  return frame;
}

constexpr std::size_t kGibibyte = std::size_t{1} << 30;

TEST(ZstdInflater, InflatesAFrameOfTheLengthThatItStates) {
  const Bytes content{1, 2, 3, 4, 5};
  Bytes out;
  ASSERT_TRUE(ZstdInflater().InflateOfItsLength(FrameThatStates(5, content), kGibibyte, out));
  EXPECT_EQ(out, content);
  EXPECT_FALSE(ZstdInflater().InflateOfItsLength(FrameThatStates(5, content), 4, out));
}

TEST(ZstdInflater, TakesNoMemoryForALengthThatAFrameCannotHold) {
  Bytes out;
  EXPECT_FALSE(ZstdInflater().InflateOfItsLength(FrameThatStates(800'000'000, {1, 2, 3, 4}),
                                                 kGibibyte, out));
  EXPECT_EQ(out.capacity(), 0U);
}

}  // namespace
}  // namespace telltale
