// Tickets with which a client goes on with its session on another stream.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace naiad {

/// 128 unpredictable bits, good for one return: until the client has proved that it got the next one. (Were
/// they void at once, an answer lost on a bad line would cost the session.) Only their SHA-256 is kept, so
/// that what a server remembers is of no use to a reader.
class ResumeTokens {
 public:
  static constexpr std::size_t kBytes = 16;

  /// A new token for a session. The one redeemed last stays good until confirm(), any other is void.
  std::string issue(std::uint64_t session);
  /// The session a token was issued for; nothing if it never was or is void. Nothing changes.
  std::optional<std::uint64_t> find(const std::string& token) const;
  /// The same, and the token is used.
  std::optional<std::uint64_t> redeem(const std::string& token);
  /// As find(), for the newest one only.
  std::optional<std::uint64_t> holderOf(const std::string& token) const;
  /// The client has got the newest token: the one before is void.
  void confirm(std::uint64_t session);
  /// Another process has redeemed the token: the one before it is to hear of that when it comes with the
  /// same, though not before confirm().
  void noteRestart(std::uint64_t session);
  /// Does the session of this token, void by now, go on in another process?
  bool isElsewhere(const std::string& token) const;
  /// SHA-256 of the tokens of a session that are good: of the newest, and of the one redeemed last. Empty:
  /// there is no such.
  struct Hashed {
    std::string newest;
    std::string redeemed;
  };
  Hashed hashed(std::uint64_t session) const;
  /// A session of a server that was killed has these.
  void restore(std::uint64_t session, const Hashed& hashed);
  /// A session goes on as another one, with its tokens.
  void move(std::uint64_t from, std::uint64_t to);
  /// The session is over.
  void forget(std::uint64_t session);

 private:
  struct Hashes {
    std::string newest;
    std::string redeemed;    ///< empty: none, or void
    std::string elsewhere;   ///< the last one void that another process redeemed
    bool restarted = false;  ///< `redeemed` was, by another process
  };
  std::optional<std::uint64_t> sessionOf(const std::string& hash) const;
  void drop(std::string& hash);
  void dropRedeemed(Hashes& hashes);

  std::unordered_map<std::string, std::uint64_t> m_sessions;  ///< by hash
  std::unordered_map<std::uint64_t, Hashes> m_hashes;         ///< by session
  std::unordered_set<std::string> m_elsewhere;                ///< hashes, one for each session at most
};

/// Unpredictable bits, from the system.
std::uint64_t randomBits();

}  // namespace naiad
