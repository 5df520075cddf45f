#include "shared/net/stream/Framing.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <stdexcept>

namespace naiad {
namespace {

std::size_t lengthIn(std::string_view header) {
  const auto low = static_cast<unsigned char>(header[0]);
  const auto high = static_cast<unsigned char>(header[1]);
  return static_cast<std::size_t>(low) | static_cast<std::size_t>(high) << 8;
}

}  // namespace

void appendFrame(std::string& out, std::string_view payload) {
  if (payload.empty()) throw std::length_error("a frame may not be empty");
  if (payload.size() > kMaxFramePayload) throw std::length_error("a frame may not exceed 65535 bytes");
  std::array<char, kFrameHeaderSize> header{};
  writeFrameHeader(header, payload.size());
  out.append(header.data(), header.size());
  out.append(payload);
}

void writeFrameHeader(std::span<char, kFrameHeaderSize> into, std::size_t length) {
  assert(length > 0 && length <= kMaxFramePayload);
  into[0] = static_cast<char>(length & 0xff);
  into[1] = static_cast<char>(length >> 8);
}

FrameReader::FrameReader(std::size_t limit) {
  setLimit(limit);
}

void FrameReader::setLimit(std::size_t limit) {
  limit_ = std::min(limit, kMaxFramePayload);
}

void FrameReader::feed(std::string_view bytes) {
  if (error_ != FrameError::kNone) return;
  if (!pending_.empty()) throw std::logic_error("FrameReader fed before it was drained");
  pending_ = bytes;
}

std::optional<std::string_view> FrameReader::next() {
  if (yielded_) {
    partial_.clear();
    yielded_ = false;
  }
  if (error_ != FrameError::kNone) return std::nullopt;
  if (partial_.empty() && pending_.size() >= kFrameHeaderSize) {
    const std::size_t length = lengthIn(pending_);
    if (!accept(length)) return std::nullopt;
    if (pending_.size() >= kFrameHeaderSize + length) {  // complete: return it without a copy
      const std::string_view frame = pending_.substr(kFrameHeaderSize, length);
      pending_.remove_prefix(kFrameHeaderSize + length);
      return frame;
    }
  }
  keep(kFrameHeaderSize);
  if (partial_.size() < kFrameHeaderSize) return std::nullopt;
  const std::size_t length = lengthIn(partial_);
  if (!accept(length)) return std::nullopt;
  keep(kFrameHeaderSize + length);
  if (partial_.size() < kFrameHeaderSize + length) return std::nullopt;
  yielded_ = true;
  return std::string_view(partial_).substr(kFrameHeaderSize);
}

/// Moves bytes from the piece to the partial frame until it has `wanted` bytes or the piece is used up.
void FrameReader::keep(std::size_t wanted) {
  if (partial_.size() >= wanted) return;
  const std::size_t count = std::min(wanted - partial_.size(), pending_.size());
  partial_.append(pending_.substr(0, count));
  pending_.remove_prefix(count);
}

bool FrameReader::accept(std::size_t length) {
  if (length != 0 && length <= limit_) return true;
  error_ = length == 0 ? FrameError::kEmpty : FrameError::kTooLarge;
  pending_ = {};
  std::string().swap(partial_);
  return false;
}

}  // namespace naiad
