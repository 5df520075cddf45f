// The keys of the servers that this user has played on: a server that changes its key is not trusted.
//
// One line for each server, "host:port fingerprint" (ServerAddress.h, Fingerprint.h); empty lines and those
// that begin with '#' are comments. Any other line is kept as it is and reported: it may be a damaged pin.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

/// Why a server is trusted, or not.
enum class Trust {
  kChain,         ///< its certificate verifies for this host name
  kPinned,        ///< the key is the one seen before
  kFirstUse,      ///< never seen: trusted now, and pinned
  kChanged,       ///< not the key seen before: refuse
  kGivenEqual,    ///< the key is the one that the player named
  kGivenUnequal,  ///< it is not: refuse
  kLinkEqual,     ///< never seen, and the key is the one of the link: pinned as a whole
  kLinkUnequal,   ///< it is not the one of the link: refuse
};

struct Verdict {
  Trust trust;
  /// For people. If the server is refused: the reason, and what to do.
  std::string sentence;

  bool accepted() const {
    return trust != Trust::kChanged && trust != Trust::kGivenUnequal && trust != Trust::kLinkUnequal;
  }
};

/// The file cannot be read or written. what() is one sentence for people.
class KnownServersError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Any thread, any number of processes on one file: writers take turns (a lock file beside it), and replace
/// it whole.
class KnownServers {
 public:
  /// $XDG_DATA_HOME/naiad/known_servers, or the same in ~/.local/share. Throws KnownServersError if the
  /// environment names neither.
  static std::filesystem::path defaultPath();

  /// The file is made, 0600, when the first server is admitted; so are its directories.
  explicit KnownServers(std::filesystem::path path) : path_(std::move(path)) {}

  /// The verdict on the server at `host`:`port`, as the player named it. `given`: the fingerprint that the
  /// player named, if any; it counts most, then the chain, then the pin. `link`: the key of the link that was
  /// followed, if any. It must fit whatever the rest says, and replaces no pin: links come from strangers.
  /// Writes nothing.
  Verdict judge(const std::string& host, std::uint16_t port, const PeerFacts& facts,
                const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link = {}) const;
  /// The same, and if the server is accepted its key is the pinned one from now on. Judgement and pin are
  /// atomic.
  Verdict admit(const std::string& host, std::uint16_t port, const PeerFacts& facts,
                const std::optional<Fingerprint>& given, const std::optional<ShortKey>& link = {}) const;

  /// A sentence for each line that is neither a pin nor a comment.
  std::vector<std::string> problems() const;

 private:
  std::filesystem::path path_;
};

}  // namespace naiad
