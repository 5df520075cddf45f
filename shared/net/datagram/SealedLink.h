// One end of a session's sealed datagrams: keys, epochs, replay protection, and the address to send to.
//
// It does no I/O and reads no clock. The owner passes it received packets and sends those that it returns. A
// sealed text begins with a byte of flags, then the payload. Bit 0: an 8-byte path challenge precedes the
// payload; bit 1: an 8-byte answer to a challenge; bit 2: a ping of one byte; bit 3: an echo of two bytes.
// The link adds and removes these fields. Only servers challenge, only clients ping.
//
// Epochs: whenever the session's keys change, both ends call startEpoch(), the client first (its TLS
// handshake also completes first). The server seals with the new keys at once. The client waits for a packet
// of the new epoch, or until the old keys expire or are used up, because the server may lack the new keys.
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

/// A challenge and its answer: 8 bytes that cannot be guessed.
using PathChallenge = std::uint64_t;

/// Chooses the path of a session's datagrams, and limits the bytes sent to it before it is validated.
///
/// The path of the newest authentic packet is the current one. An attacker can resend a copied packet from
/// any address, so a path that has not answered a challenge gets at most three times the bytes that came from
/// it (RFC 9000, 8.1, 8.2 and 9.3). The budget grows with received bytes, not with time. The last validated
/// path is remembered: a copy that overtakes its original moves the session for one packet only, and
/// returning needs no new challenge.
class PathValidator {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Bytes that may be sent to an unproven path for each byte received from it.
  static constexpr std::uint64_t kAmplification = 3;
  /// Interval after which an unanswered challenge is repeated, in an empty packet if there is no payload.
  static constexpr std::chrono::milliseconds kChallengeInterval{250};

  /// Records the newest authentic packet, received on `path`. Returns true if that changes the path;
  /// `challenge` is then stored for it.
  bool onPacket(const Path& path, std::size_t bytes, PathChallenge challenge);
  /// Records an authentic packet that is not the newest: it can only increase the budget of the current path.
  void onLatePacket(const Path& path, std::size_t bytes);
  /// Checks an answer, received on any path. Returns true if it proves the current path.
  bool onResponse(PathChallenge answer);

  /// Makes `path` the current one and lets it count as validated, without proof.
  void setUnvalidated(const Path& path);

  /// The current path; nullopt before the first packet.
  const std::optional<Path>& current() const { return current_; }
  /// True if the peer has proved that it receives packets on the current path, or setUnvalidated() set it.
  bool validated() const { return validated_; }
  /// The challenge to add to each packet until the path is validated.
  PathChallenge challenge() const { return challenge_; }
  /// The number of bytes that may be sent now; unlimited once validated.
  std::size_t budget() const;
  /// Records a sent packet: subtracts its size from the budget. Does nothing once the path is validated.
  void onSent(std::size_t bytes, Time now);
  /// True if a challenge is due, which is sent even without a payload.
  bool needsChallenge(Time now) const;

 private:
  std::optional<Path> current_;
  std::optional<Path> validated_path_;
  bool validated_ = false;  // true if current_ and validated_path_ are equal
  PathChallenge challenge_ = 0;
  std::uint64_t bytes_in_ = 0;  // bytes received since this path became current
  std::uint64_t bytes_out_ = 0;
  std::optional<Time> challenged_;
};

/// Counters of a link: what happened to each datagram and payload.
struct SealedLinkCounters {
  std::uint64_t opened = 0;         ///< authentic, and payload passed on
  std::uint64_t too_short = 0;      ///< shorter than any sealed datagram
  std::uint64_t too_long = 0;       ///< more than 1200 bytes
  std::uint64_t bad_kind = 0;       ///< a reserved kind, or that of the other direction
  std::uint64_t wrong_id = 0;       ///< id of another session
  std::uint64_t unknown_epoch = 0;  ///< an epoch without keys
  std::uint64_t too_old = 0;        ///< behind the replay window
  std::uint64_t replayed = 0;       ///< opened before
  std::uint64_t forged = 0;         ///< failed authentication
  std::uint64_t exhausted = 0;      ///< its key has seen too many forgeries
  std::uint64_t malformed = 0;      ///< authentic, but with invalid flags or fields

  std::uint64_t sealed = 0;
  std::uint64_t no_path = 0;      ///< not sealed: the address is unknown before the first authentic packet
  std::uint64_t no_key = 0;       ///< not sealed: no epoch, or its key is used up
  std::uint64_t over_budget = 0;  ///< not sealed: over the budget of an address not yet validated

  std::uint64_t path_changes = 0;
  std::uint64_t paths_validated = 0;
  std::uint64_t wrong_answers = 0;  ///< answers to other challenges, or after validation
};

/// Buffers for packets. Links used by one thread share them, so that they stay in the CPU cache.
struct SealScratch {
  std::array<char, kMaxDatagram> sealed;
  std::array<char, kMaxDatagram> opened;
};

/// Not thread-safe. All times come from one monotonic clock. Keeps at most two epochs.
class SealedLink {
 public:
  using Time = PathValidator::Time;
  enum class Role : std::uint8_t { kClient, kServer };

  /// Time for which packets of the previous epoch are accepted.
  static constexpr std::chrono::seconds kPreviousEpoch{10};

  struct Options {
    Role role = Role::kClient;
    ConnectionId id;
    /// Returns 64 unpredictable bits for a path challenge; needed only by servers.
    std::function<std::uint64_t()> random;
    SealLimits limits;
    std::shared_ptr<SealScratch> scratch = {};  ///< null: the link allocates one
  };

  explicit SealedLink(Options options);
  SealedLink(const SealedLink&) = delete;
  SealedLink& operator=(const SealedLink&) = delete;

  /// Adds the keys of a new epoch, keeps those of epoch() for kPreviousEpoch, and drops older ones. Returns
  /// false and changes nothing unless `epoch` is 1 … 15 above epoch(); the first epoch may have any number.
  bool startEpoch(Epoch epoch, const DatagramKeys& keys, Time now);
  /// Sets the server's address; only for clients. Servers learn their path from received packets.
  void setServerPath(const Path& path);

  /// Returns the payload of an authentic packet, valid until the next open() with this scratch; nullopt if
  /// the packet was refused. An empty payload is a probe, or came with a challenge or answer only. A server
  /// follows the path of the newest packet; a client accepts authentic packets from any address.
  std::optional<std::string_view> open(const Path& path, std::string_view packet, Time now);
  /// True if open() would decrypt the packet. If not, the refusal is counted.
  bool isPlausible(std::string_view packet, Time now);

  struct Outgoing {
    Path path;
    std::string_view packet;  ///< the packet, in `memory` or, until the next seal(), in the scratch
  };
  /// Seals at most maxPayload() bytes. Returns nullopt if they may not be sent now; the reason is counted.
  /// `memory`: buffer for the packet, kMaxDatagram bytes that do not overlap the payload; null: the scratch.
  std::optional<Outgoing> seal(std::string_view payload, Time now, char* memory = nullptr);
  /// Measures the round trip with the next packet that has a byte to spare; only for clients.
  void ping() { ping_.request(); }
  /// Returns the round trip measured since the last call, without the time that the server held the ping.
  std::optional<LinkPing::Millis> popRoundTrip() { return ping_.popRoundTrip(); }
  /// True if a challenge or an answer is due and may be sent: seal an empty payload if there is no other one.
  bool needsToSend(Time now) const;

  /// The largest payload that always fits a packet: 1164 bytes for clients, 1172 for servers.
  std::size_t maxPayload() const;
  /// Returns the size of the largest payload that seal() accepts now: it may be less than maxPayload() until
  /// a new address is validated; nullopt if seal() would not accept even an empty one.
  std::optional<std::size_t> payloadBudget() const;

  /// True if a key of either direction nears its limit: start a new epoch. Only one of the two ends needs to
  /// ask for it.
  bool needsNewEpoch() const {
    return newest_ && (newest_->sealer.needsNewEpoch() || newest_->opener.exhausted() ||
                       newest_->opener.expected() >= options_.limits.new_epoch_after);
  }
  /// Returns the newest started epoch; nullopt before the first.
  std::optional<Epoch> epoch() const;
  /// Returns the path of sent packets; nullopt before a client's setServerPath(), or before a server's first
  /// authentic packet.
  std::optional<Path> path() const { return validator_.current(); }
  /// True if `path` is this session's current path, and validated.
  bool isValidated(const Path& path) const { return validator_.validated() && validator_.current() == path; }
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
  void onPath(const Path& path, std::size_t bytes, std::pair<Epoch, std::uint64_t> number);
  void onChallengeResponse(PathChallenge answer);
  std::size_t overhead() const;
  std::size_t writeFields(char* out, std::size_t spare, Time now);
  std::size_t writePing(char* flags, char* out, std::size_t spare, Time now);

  Options options_;
  std::optional<Keys> newest_;
  Time previous_until_ = Time::max();
  bool confirmed_ = false;                                        // true if the other end has the newest keys
  std::optional<std::pair<Epoch, std::uint64_t>> newest_number_;  // epoch and number of the newest packet
  PathValidator validator_;
  std::optional<PathChallenge> pending_answer_;
  LinkPing ping_;
  LinkEcho echo_;
  SealedLinkCounters counters_;
  std::optional<Keys> previous_;  // last member because it is rarely used
};

}  // namespace naiad
