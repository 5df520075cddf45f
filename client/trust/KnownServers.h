// File of the keys of the servers that this user has played on. A server that changes its key is not trusted
// any more, unless its certificate verifies or the player gives the new key.
//
// One line for each server, "host:port fingerprint" (ServerAddress.h, Fingerprint.h); empty lines and lines
// that begin with '#' are comments. Any other line stays in the file and is reported: a pin may be damaged.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// Reason why a server is trusted or not.
enum class Trust {
  kChain,                ///< trusted: the certificate verifies for this host name
  kPinned,               ///< trusted: the key was seen before
  kFirstUse,             ///< trusted: the server was never seen before
  kChanged,              ///< refused: not the key seen before
  kFingerprintMatch,     ///< trusted: the fingerprint that the player gave
  kFingerprintMismatch,  ///< refused: not the fingerprint that the player gave
  kLinkMatch,            ///< trusted: never seen before, and the key is that in the link
  kLinkMismatch,         ///< refused: the key is not that in the link
};

struct TrustResult {
  Trust trust;
  /// Message for people. If the server is refused: the reason, and what to do.
  std::string message;

  bool accepted() const {
    return trust != Trust::kChanged && trust != Trust::kFingerprintMismatch && trust != Trust::kLinkMismatch;
  }
};

/// Thrown if the file cannot be read or written. what() is one message for people.
class KnownServersError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thread-safe, and any number of processes may use one file: writers lock NAME.lock and replace the file.
class KnownServers {
 public:
  /// Returns naiad/known_servers in $XDG_DATA_HOME, or in ~/.local/share. Throws KnownServersError if neither
  /// XDG_DATA_HOME nor HOME is set.
  static std::filesystem::path defaultPath();

  /// The file, mode 0600, and its directories are created when the first server is admitted.
  explicit KnownServers(std::filesystem::path path) : path_(std::move(path)) {}

  /// Decides whether the server at `host`:`port`, as typed by the player, is trusted. `given`: fingerprint
  /// that the player gave, if any; it has priority over the certificate chain, and the chain over the pin.
  /// `link`: the key of the link that was followed, if any. It must always match, but does not replace a pin,
  /// because links come from strangers. Writes nothing.
  TrustResult verify(const std::string& host, std::uint16_t port, const PeerIdentity& facts,
                     const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link = {}) const;
  /// Like verify(), but if the server is accepted, pins its key in place of an earlier one. Both happen in
  /// one atomic step. If it is refused, writes nothing.
  TrustResult admit(const std::string& host, std::uint16_t port, const PeerIdentity& facts,
                    const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link = {}) const;

  /// Returns a message for each line that is neither a pin nor a comment.
  std::vector<std::string> problems() const;

 private:
  std::filesystem::path path_;
};

}  // namespace naiad
