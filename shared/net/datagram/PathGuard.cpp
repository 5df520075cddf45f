#include "shared/net/datagram/PathGuard.h"

#include <limits>

namespace naiad {

bool PathGuard::arrived(const Path& path, std::size_t bytes, PathChallenge challenge) {
  const bool moved = current_ != path;
  if (moved) {
    current_ = path;
    validated_ = current_ == proven_;
    challenge_ = challenge;
    bytes_in_ = bytes_out_ = 0;
    challenged_.reset();
  }
  bytes_in_ += bytes;
  return moved;
}

void PathGuard::arrivedLate(const Path& path, std::size_t bytes) {
  if (current_ == path) bytes_in_ += bytes;
}

bool PathGuard::answered(PathChallenge answer) {
  if (!current_ || validated() || !challenged_ || answer != challenge_) return false;
  proven_ = current_;
  validated_ = true;
  return true;
}

void PathGuard::trust(const Path& path) {
  current_ = proven_ = path;
  validated_ = true;
}

std::size_t PathGuard::budget() const {
  if (validated()) return std::numeric_limits<std::size_t>::max();
  const std::uint64_t allowed = kAmplification * bytes_in_;
  return allowed > bytes_out_ ? allowed - bytes_out_ : 0;
}

void PathGuard::sent(std::size_t bytes, Time now) {
  if (validated()) return;
  bytes_out_ += bytes;
  challenged_ = now;
}

bool PathGuard::wantsChallenge(Time now) const {
  return current_ && !validated() && (!challenged_ || now - *challenged_ >= kChallengeInterval);
}

}  // namespace naiad
