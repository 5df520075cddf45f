// Tokens with which a client resumes its session on another stream.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace naiad {

/// A token is 128 unpredictable bits, valid until the client has proved that it received the next one. (If a
/// token became void by its first use, an answer lost on a bad line would cost the session.) Only its SHA-256
/// is stored, so that a reader of the server's memory cannot use it.
class ResumeTokens {
 public:
  static constexpr std::size_t kBytes = 16;

  /// Issues a token for a session. The token redeemed last stays valid until confirm(), or until another one
  /// is redeemed; all others become void.
  std::string issue(std::uint64_t session);
  /// Returns the session of a token; nullopt if it was never issued or is void.
  std::optional<std::uint64_t> find(const std::string& token) const;
  /// Like find(), and marks the token as redeemed.
  std::optional<std::uint64_t> redeem(const std::string& token);
  /// Like find(), but only for the session's newest token.
  std::optional<std::uint64_t> findNewest(const std::string& token) const;
  /// Call when the client has received the newest token: the previous one becomes void.
  void confirm(std::uint64_t session);
  /// Call when another process has redeemed the token. After confirm(), isSuperseded() is true for this
  /// token, so the previous process learns why it is refused.
  void markSuperseded(std::uint64_t session);
  /// True if this token is void and its session continues in another process.
  bool isSuperseded(const std::string& token) const;
  /// SHA-256 of a session's valid tokens: the newest, and the one redeemed last. Empty: no such token.
  struct Hashed {
    std::string newest;
    std::string redeemed;
  };
  Hashed hashed(std::uint64_t session) const;
  /// Restores the tokens of a session of a killed server.
  void restore(std::uint64_t session, const Hashed& hashed);
  /// Moves the tokens of one session to another, which replaces it.
  void move(std::uint64_t from, std::uint64_t to);
  /// Call when the session is over.
  void forget(std::uint64_t session);

 private:
  struct Hashes {
    std::string newest;
    std::string redeemed;    ///< empty: none, or void
    std::string superseded;  ///< newest void token that another process had redeemed
    bool restarted = false;  ///< true if another process of the client redeemed the token of `redeemed`
  };
  std::optional<std::uint64_t> sessionOf(const std::string& hash) const;
  /// Removes the hash from m_sessions, and empties the string.
  void drop(std::string& hash);
  void dropRedeemed(Hashes& hashes);

  std::unordered_map<std::string, std::uint64_t> m_sessions;  ///< keyed by hash
  std::unordered_map<std::uint64_t, Hashes> m_hashes;         ///< keyed by session
  std::unordered_set<std::string> m_superseded;  ///< hashes of superseded tokens, at most one per session
};

/// Returns unpredictable bits from the system.
std::uint64_t randomBits();

}  // namespace naiad
