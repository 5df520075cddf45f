#include "shared/net/datagram/ReplayWindow.h"

namespace naiad {

std::uint64_t restoreSequence(std::uint64_t expected, std::uint16_t wire) {
  constexpr std::uint64_t kWindow = 1u << 16;
  constexpr std::uint64_t kHalf = kWindow / 2;
  const std::uint64_t candidate = (expected & ~(kWindow - 1)) | wire;
  if (candidate + kHalf <= expected && candidate < (std::uint64_t{1} << 62) - kWindow) {
    return candidate + kWindow;
  }
  if (candidate > expected + kHalf && candidate >= kWindow) return candidate - kWindow;
  return candidate;
}

ReplayWindow::Verdict ReplayWindow::check(std::uint64_t sequence) const {
  if (sequence >= expected_) return Verdict::kNew;
  if (expected_ - sequence > kSize) return Verdict::kTooOld;
  return word(sequence) >> (sequence % 64) & 1 ? Verdict::kSeen : Verdict::kNew;
}

void ReplayWindow::mark(std::uint64_t sequence) {
  if (sequence >= expected_) {
    // The numbers skipped over take the bits of those that fall out of the window.
    if (sequence - expected_ >= kSize) {
      seen_.fill(0);
    } else {
      for (std::uint64_t skipped = expected_; skipped != sequence; ++skipped) {
        seen_[(skipped / 64) % seen_.size()] &= ~(std::uint64_t{1} << (skipped % 64));
      }
    }
    expected_ = sequence + 1;
  }
  seen_[(sequence / 64) % seen_.size()] |= std::uint64_t{1} << (sequence % 64);
}

}  // namespace naiad
