// The sealed datagrams of one session, at one end: keys, epochs, replay, and the address to send to.
//
// It does no I/O and reads no clock. The owner feeds it what a socket received and sends what it returns.
// Inside the seal, in front of the payload, is one byte of flags: bit 0, an 8-byte path challenge follows;
// bit 1, an 8-byte answer to one follows; bit 2, a ping, of one byte; bit 3, its echo, of two. The link adds
// and strips them. Only servers challenge, only clients ping.
//
// Epochs: whenever the session's keys change, both ends call startEpoch(), the client first (its TLS
// handshake completes first, too). The server then seals with the new keys at once; the client does so when a
// packet of the new epoch has come, or when the old keys expire, so that it never uses keys the server lacks.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

#include "shared/net/datagram/DatagramKeys.h"
#include "shared/net/datagram/LinkPing.h"
#include "shared/net/datagram/Path.h"
#include "shared/net/datagram/Seal.h"
#include "shared/net/datagram/SealedHeader.h"

namespace naiad {

/// What a challenge and its answer are: 8 bytes that cannot be guessed.
using PathChallenge = std::uint64_t;

/// Where a session's datagrams go, and how many bytes may go there before that address is validated.
///
/// The path of the newest authentic packet is the current one. A copied packet can be made to come from
/// anywhere, so a path that has not answered a challenge yet gets at most three times the bytes that came
/// from it (RFC 9000, 8.1, 8.2 and 9.3). This is no token bucket: bytes refill it, not time. The path
/// validated last is remembered: a copy that overtakes its original moves the session for one packet only,
/// and coming back costs nothing.
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
  /// True if the peer has proved that it receives packets on this path.
  bool validated() const { return validated_; }
  /// To be sent along with everything as long as the path is not validated.
  PathChallenge challenge() const { return challenge_; }
  /// Bytes that may be sent now; no limit once validated.
  std::size_t budget() const;
  /// Takes this many bytes from the budget.
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

/// What a link did with every datagram it was given, and with every payload.
struct SealedLinkCounters {
  std::uint64_t opened = 0;         ///< authentic, and handed on
  std::uint64_t too_short = 0;      ///< cannot be a sealed datagram
  std::uint64_t too_long = 0;       ///< more than 1200 bytes
  std::uint64_t bad_kind = 0;       ///< reserved, or of the other direction
  std::uint64_t wrong_id = 0;       ///< another session's
  std::uint64_t unknown_epoch = 0;  ///< no keys (any more) for it
  std::uint64_t too_old = 0;        ///< behind the replay window
  std::uint64_t replayed = 0;       ///< opened before
  std::uint64_t forged = 0;         ///< failed authentication
  std::uint64_t exhausted = 0;      ///< its key had seen too many forgeries already
  std::uint64_t malformed = 0;      ///< authentic, but the flags make no sense

  std::uint64_t sealed = 0;
  std::uint64_t no_path = 0;      ///< not sealed: nothing authentic has come yet, so there is no address
  std::uint64_t no_key = 0;       ///< not sealed: no epoch, or its key has sealed all it may
  std::uint64_t over_budget = 0;  ///< not sealed: too much for an address that has not answered yet

  std::uint64_t path_changes = 0;
  std::uint64_t paths_validated = 0;
  std::uint64_t wrong_answers = 0;  ///< to no challenge of the current path (late, mostly)
};

/// Where packets are sealed and opened. Links that one thread uses in turn share it, so that it stays in the
/// cache.
struct SealScratch {
  std::array<char, kMaxDatagram> sealed;
  std::array<char, kMaxDatagram> opened;
};

/// Not thread-safe. Times are of one monotonic clock. At most two epochs are held.
class SealedLink {
 public:
  using Time = PathGuard::Time;
  enum class Role : std::uint8_t { kClient, kServer };

  /// How long packets of the previous epoch are still accepted.
  static constexpr std::chrono::seconds kPreviousEpoch{10};

  struct Options {
    Role role = Role::kClient;
    ConnectionId id;
    /// 64 unpredictable bits for path challenges. Servers only.
    std::function<std::uint64_t()> random;
    SealLimits limits;
    std::shared_ptr<SealScratch> scratch = {};  ///< null: one of its own
  };

  explicit SealedLink(Options options);
  SealedLink(const SealedLink&) = delete;
  SealedLink& operator=(const SealedLink&) = delete;

  /// New keys. The keys before the last are forgotten at once. False, and nothing changes, unless `epoch` is
  /// newer than the last by 1 … 15; the first may be any.
  bool startEpoch(Epoch epoch, const DatagramKeys& keys, Time now);
  /// Clients only: where the server is. Servers learn their path from what arrives.
  void setServerPath(const Path& path);

  /// The payload of an authentic packet, valid until the next open() with this scratch; nothing if it was
  /// refused. An empty payload is one, too: a probe, or a challenge by itself. A server follows the path of
  /// the newest packet; a client takes what is authentic from wherever it comes.
  std::optional<std::string_view> open(const Path& path, std::string_view packet, Time now);
  /// Whether open() would get as far as decrypting. If not, the refusal is counted.
  bool plausible(std::string_view packet, Time now);

  struct Outgoing {
    Path path;
    std::string_view packet;  ///< in `memory`; in the scratch valid until the next seal() with it
  };
  /// Seals at most maxPayload() bytes. Nothing if it may not be sent now; the reason is counted.
  /// `memory`: where the packet is made, kMaxDatagram bytes that do not overlap the payload; null: the
  /// scratch.
  std::optional<Outgoing> seal(std::string_view payload, Time now, char* memory = nullptr);
  /// Clients only: measure the round trip with the next packet that has a byte to spare.
  void ping() { ping_.ask(); }
  /// The round trip measured since the last call, without what the server waited before it answered.
  std::optional<LinkPing::Millis> takeRoundTrip() { return ping_.takeRoundTrip(); }
  /// Something of the link's own (a challenge, an answer) is due: seal an empty payload if there is no other.
  bool wantsToSend(Time now) const;

  /// The largest payload that always fits a packet: 1164 bytes for clients, 1172 for servers.
  std::size_t maxPayload() const;
  /// The largest payload that seal() would send now: less than maxPayload() as long as a new address has not
  /// answered. Nothing if not even an empty one.
  std::optional<std::size_t> room() const;

  /// A key of either direction nears its limit: the session should agree on a new epoch. So it is enough if
  /// one end asks.
  bool wantsNewEpoch() const {
    return newest_ && (newest_->sealer.wantsNewEpoch() || newest_->opener.exhausted() ||
                       newest_->opener.expected() >= options_.limits.new_epoch_after);
  }
  /// The newest epoch started.
  std::optional<Epoch> epoch() const;
  /// Where packets go. None on a server that nothing authentic has come to.
  std::optional<Path> path() const { return guard_.current(); }
  /// Whether packets that come by `path` come from where this session has proved to be.
  bool isValidated(const Path& path) const { return guard_.validated() && guard_.current() == path; }
  ConnectionId id() const { return options_.id; }
  const SealedLinkCounters& counters() const { return counters_; }

 private:
  struct Keys {
    Epoch epoch;
    Sealer sealer;
    Opener opener;
  };
  struct Fields {
    std::optional<PathChallenge> challenge;
    std::optional<PathChallenge> answer;
    std::optional<std::uint8_t> ping;
    std::optional<LinkPing::Echo> echo;
    std::string_view payload;
  };

  bool isServer() const { return options_.role == Role::kServer; }
  SealDirection sends() const {
    return isServer() ? SealDirection::kServerToClient : SealDirection::kClientToServer;
  }
  SealDirection receives() const {
    return isServer() ? SealDirection::kClientToServer : SealDirection::kServerToClient;
  }
  void expire(Time now);
  Keys* sendingKeys();
  const Keys* sendingKeys() const { return const_cast<SealedLink*>(this)->sendingKeys(); }
  Keys* findKeys(Epoch epoch_bits);
  Keys* admit(std::string_view packet, Time now);
  bool accept(OpenResult result);
  std::optional<Fields> readFields(std::string_view text) const;
  void notePath(const Path& path, std::size_t bytes, std::pair<Epoch, std::uint64_t> number);
  void noteAnswer(PathChallenge answer);
  std::size_t overhead() const;
  std::size_t writeFields(char* out, std::size_t spare, Time now);
  std::size_t writePing(char* flags, char* out, std::size_t spare, Time now);

  Options options_;
  std::optional<Keys> newest_;
  Time previous_until_ = Time::max();
  bool confirmed_ = false;                                        // the other end has the newest keys
  std::optional<std::pair<Epoch, std::uint64_t>> newest_number_;  // of the authentic packets
  PathGuard guard_;
  std::optional<PathChallenge> pending_answer_;
  LinkPing ping_;
  LinkEcho echo_;
  SealedLinkCounters counters_;
  std::optional<Keys> previous_;  // last: hardly ever looked at
};

}  // namespace naiad
