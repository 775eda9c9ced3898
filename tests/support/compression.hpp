#pragma once

#include <cstddef>
#include <string>

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

namespace telltale {

/// A frame of these bytes.
inline std::string Zstd(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
  return packed;
}

/// A frame of these bytes.
inline std::string Lz4(const std::string& bytes) {
  std::string packed(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
  packed.resize(
      LZ4F_compressFrame(packed.data(), packed.size(), bytes.data(), bytes.size(), nullptr));
  return packed;
}

/// A stream of these bytes.
inline std::string Bz2(const std::string& bytes) {
  constexpr int kLargestBlock = 9;
  // By the manual of libbzip2 it takes at most a hundredth and 600 bytes more.
  std::string packed(bytes.size() + bytes.size() / 100 + 601, '\0');
  auto size = static_cast<unsigned int>(packed.size());
  BZ2_bzBuffToBuffCompress(packed.data(), &size, const_cast<char*>(bytes.data()),
                           static_cast<unsigned int>(bytes.size()), kLargestBlock, 0, 0);
  packed.resize(size);
  return packed;
}

/// A file of these bytes.
inline std::string Gzip(const std::string& bytes) {
  constexpr int kLargestWindow = 15;
  constexpr int kAsGzip = 16;
  z_stream stream{};
  deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kLargestWindow + kAsGzip, 8,
               Z_DEFAULT_STRATEGY);
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  deflate(&stream, Z_FINISH);
  packed.resize(stream.total_out);
  deflateEnd(&stream);
  return packed;
}

}  // namespace telltale
