// Tickets with which a client goes on with its session on another stream.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>

namespace naiad {

/// 128 unpredictable bits, valid once. Only their SHA-256 is kept, so that what a server remembers is of no
/// use to whoever reads it.
class ResumeTokens {
 public:
  static constexpr std::size_t kBytes = 16;

  /// A new token for a session; the one before is void.
  std::string issue(std::uint64_t session);
  /// The session a token was issued for; nothing if it never was or was used. It is used now.
  std::optional<std::uint64_t> redeem(const std::string& token);
  /// The session is over.
  void forget(std::uint64_t session);

 private:
  std::unordered_map<std::string, std::uint64_t> m_sessions;  ///< by hash
  std::unordered_map<std::uint64_t, std::string> m_hashes;    ///< by session
};

/// Unpredictable bits, from the system.
std::uint64_t randomBits();

}  // namespace naiad
