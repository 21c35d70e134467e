// SPDX-License-Identifier: MIT
// Copyright (c) 2026 the thermopower authors

#include "chunk_compression.hpp"

#include <thermopower/io/input_error.hpp>

#if defined(THERMOPOWER_HAS_ZSTD)
#include <zstd.h>
#endif
#if defined(THERMOPOWER_HAS_LZ4)
#include <lz4frame.h>
#endif

#include <algorithm>
#include <memory>

namespace thermopower::io {
namespace {

#if defined(THERMOPOWER_HAS_ZSTD) || defined(THERMOPOWER_HAS_LZ4)
// Grows with what comes out and not with what a damaged file says will come.
constexpr std::size_t least_growth = std::size_t{1} << 20;

// Makes room behind `used` bytes; false where all of `size` are used, and one byte more would be too many.
bool make_room(std::vector<unsigned char>& out, std::size_t used, std::size_t size) {
  if (used < out.size()) return true;
  if (used >= size) return false;
  out.resize(std::min(size, std::max(used + least_growth, 2 * used)));
  return true;
}
#endif

#if defined(THERMOPOWER_HAS_ZSTD)
std::string unpack_zstd(const unsigned char* bytes, std::size_t count, std::size_t size,
                        std::vector<unsigned char>& out) {
  static thread_local const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> context(ZSTD_createDCtx(),
                                                                                            &ZSTD_freeDCtx);
  ZSTD_DCtx_reset(context.get(), ZSTD_reset_session_only);
  ZSTD_inBuffer in{bytes, count, 0};
  std::size_t used = 0, expected = 1;
  unsigned char beyond = 0;
  while (in.pos < in.size || expected != 0) {
    const bool room = make_room(out, used, size);
    ZSTD_outBuffer to{room ? out.data() + used : &beyond, room ? out.size() - used : 1, 0};
    const std::size_t before = in.pos;
    expected = ZSTD_decompressStream(context.get(), &to, &in);
    if (ZSTD_isError(expected) != 0) return std::string("zstd: ") + ZSTD_getErrorName(expected);
    if (!room && to.pos > 0) return "zstd: more bytes come out than the chunk says";
    used += room ? to.pos : 0;
    if (to.pos == 0 && in.pos == before && expected != 0) return "zstd: the frame is cut off";
  }
  out.resize(used);
  return {};
}
#endif

#if defined(THERMOPOWER_HAS_LZ4)
std::string unpack_lz4(const unsigned char* bytes, std::size_t count, std::size_t size,
                       std::vector<unsigned char>& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return "lz4: out of memory";
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(raw,
                                                                             &LZ4F_freeDecompressionContext);
  std::size_t used = 0, taken = 0, expected = 1;
  unsigned char beyond = 0;
  while (taken < count || expected != 0) {
    const bool room = make_room(out, used, size);
    std::size_t to = room ? out.size() - used : 1, from = count - taken;
    expected = LZ4F_decompress(context.get(), room ? out.data() + used : &beyond, &to, bytes + taken, &from,
                               nullptr);
    if (LZ4F_isError(expected) != 0) return std::string("lz4: ") + LZ4F_getErrorName(expected);
    if (!room && to > 0) return "lz4: more bytes come out than the chunk says";
    used += room ? to : 0;
    taken += from;
    if (to == 0 && from == 0 && expected != 0) return "lz4: the frame is cut off";
  }
  out.resize(used);
  return {};
}
#endif

}  // namespace

std::string unpack_chunk(const std::string& compression, const unsigned char* bytes, std::size_t count,
                         std::size_t size, std::vector<unsigned char>& out) {
  std::string fault;
  out.clear();
  if (compression.empty()) {
    out.assign(bytes, bytes + count);
  } else if (compression == "zstd") {
#if defined(THERMOPOWER_HAS_ZSTD)
    fault = unpack_zstd(bytes, count, size, out);
#else
    return "compressed with zstd, which this build cannot unpack; expected a build with Debian's libzstd-dev";
#endif
  } else if (compression == "lz4") {
#if defined(THERMOPOWER_HAS_LZ4)
    fault = unpack_lz4(bytes, count, size, out);
#else
    return "compressed with lz4, which this build cannot unpack; expected a build with Debian's liblz4-dev";
#endif
  } else {
    return "compressed with " + excerpt(compression) + "; expected zstd, lz4 or none";
  }
  if (fault.empty() && out.size() != size)
    fault = "unpacks to " + std::to_string(out.size()) + " bytes; the chunk says " + std::to_string(size);
  return fault;
}

}  // namespace thermopower::io
