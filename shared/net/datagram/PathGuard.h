// Where a session's datagrams go, and how many bytes may go there before that address is validated.
//
// The path of the newest authentic packet is the current one. A copied packet can be made to come from
// anywhere, so a path that has not answered a challenge yet gets at most three times the bytes that came from
// it (RFC 9000, 8.1, 8.2 and 9.3). This is no token bucket: bytes refill it, not time. The path validated
// last is remembered: a copy that overtakes its original moves the session for one packet only, and coming
// back costs nothing.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "shared/net/datagram/Path.h"

namespace naiad {

/// What a challenge and its answer are: 8 bytes that cannot be guessed.
using PathChallenge = std::uint64_t;

class PathGuard {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Bytes to an unproven path for each byte from it.
  static constexpr std::uint64_t kAmplification = 3;
  /// An unanswered challenge is worth a packet of its own this often.
  static constexpr std::chrono::milliseconds kChallengeInterval{250};

  /// An authentic packet, the newest so far, came by `path`. True if that is another path than before;
  /// `challenge` is kept for it then.
  bool arrived(const Path& path, std::size_t bytes, PathChallenge challenge);
  /// An authentic packet, not the newest, came by `path`: only its bytes count.
  void arrivedLate(const Path& path, std::size_t bytes);
  /// An answer came (by whatever path). True if it proves the current path.
  bool answered(PathChallenge answer);

  /// From now on `path` is the current one and needs no proof.
  void trust(const Path& path);

  /// None before the first packet.
  const std::optional<Path>& current() const { return current_; }
  bool validated() const { return validated_; }
  /// To be sent along with everything as long as the path is not validated.
  PathChallenge challenge() const { return challenge_; }
  /// Bytes that may be sent now; no limit once validated.
  std::size_t budget() const;
  void sent(std::size_t bytes, Time now);
  /// It is time to challenge the path, even with an empty packet.
  bool wantsChallenge(Time now) const;

 private:
  std::optional<Path> current_;
  std::optional<Path> proven_;
  bool validated_ = false;  // they are the same
  PathChallenge challenge_ = 0;
  std::uint64_t bytes_in_ = 0;  // since this path is the current one
  std::uint64_t bytes_out_ = 0;
  std::optional<Time> challenged_;
};

}  // namespace naiad
