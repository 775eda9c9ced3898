#include "telltale/service/storage/packed_blob.hpp"

#include <string>

#include <gtest/gtest.h>

namespace telltale {
namespace {

TEST(PackedBlob, ComesBackAsItWas) {
  for (const std::string& bytes : {std::string(), std::string("a"), std::string(1'000'000, 'b')}) {
    EXPECT_EQ(UnpackBlob(PackBlob(bytes)), bytes);
  }
}

TEST(PackedBlob, IsRefusedWhereABitHasChanged) {
  const std::string blob = PackBlob("samples of a window");
  for (std::size_t at = 0; at < blob.size(); ++at) {
    std::string damaged = blob;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    EXPECT_FALSE(UnpackBlob(damaged)) << at;
  }
  EXPECT_FALSE(UnpackBlob(""));
}

}  // namespace
}  // namespace telltale
