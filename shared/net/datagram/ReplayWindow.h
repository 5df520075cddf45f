// Which sequence numbers have been seen: the newest, and a bit for each of those just before it.
#pragma once

#include <array>
#include <cstdint>

namespace naiad {

/// The full number whose low 16 bits are `wire` and which is nearest to the one expected next
/// (RFC 9000, appendix A.3): right whenever it is less than 2¹⁵ away.
std::uint64_t restoreSequence(std::uint64_t expected, std::uint16_t wire);

/// A number that is kNew may be tried; only what then proves authentic is marked. Otherwise a forger could
/// make the window forget, or shut out, what is real. (RFC 4303, 3.4.3.)
class ReplayWindow {
 public:
  /// Numbers that are still distinguished, the newest included.
  static constexpr std::uint64_t kSize = 1024;

  enum class Verdict : std::uint8_t { kNew, kSeen, kTooOld };

  Verdict check(std::uint64_t sequence) const;
  void mark(std::uint64_t sequence);

  /// One more than the newest number marked; 0 before the first.
  std::uint64_t expected() const { return expected_; }

 private:
  std::uint64_t word(std::uint64_t sequence) const { return seen_[(sequence / 64) % seen_.size()]; }

  std::uint64_t expected_ = 0;
  std::array<std::uint64_t, kSize / 64> seen_{};  // a ring: bit (n mod kSize) of the last kSize numbers
};

}  // namespace naiad
