// Both ends of a session's sealed datagrams. The test carries packets between them.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <string_view>

#include "SealKit.h"
#include "shared/net/datagram/SealedLink.h"
#include "shared/values/SplitMix64.h"

namespace naiad::test {

inline constexpr ConnectionId kSession{0x1122334455667788};

inline Path pathFrom(std::string_view address, std::uint16_t port = 40'000) {
  return {.local = *makeEndpoint("192.0.2.1", 9876), .remote = *makeEndpoint(address, port)};
}

/// A copy of a packet, because links return only views.
struct Packet {
  Path path;
  std::string bytes;
};

struct LinkPair {
  using Time = SealedLink::Time;

  explicit LinkPair(AeadId cipher = AeadId::kAes128Gcm, SealLimits limits = {}, ConnectionId id = kSession)
      : aead(cipher),
        client({.role = SealedLink::Role::kClient, .id = id, .random = {}, .limits = limits}),
        server({.role = SealedLink::Role::kServer,
                .id = id,
                .random = [this] { return random.next(); },
                .limits = limits}) {
    client.setServerPath({.local = {}, .remote = *makeEndpoint("192.0.2.1", 9876)});
    startEpoch(0);
  }
  void startEpoch(Epoch epoch) {
    client.startEpoch(epoch, keys(epoch), now);
    server.startEpoch(epoch, keys(epoch), now);
  }
  DatagramKeys keys(Epoch epoch) const { return knownKeys(aead, client.id(), epoch); }

  std::optional<Packet> seal(SealedLink& link, std::string_view payload) {
    const auto outgoing = link.seal(payload, now);
    if (!outgoing) return std::nullopt;
    return Packet{outgoing->path, std::string(outgoing->packet)};
  }
  std::string fromClient(std::string_view payload) { return seal(client, payload)->bytes; }
  std::string fromServer(std::string_view payload) { return seal(server, payload)->bytes; }

  /// Returns the payload; "<refused>" if the packet is refused.
  std::string toServer(std::string_view packet, const Path& path) {
    return std::string(server.open(path, packet, now).value_or("<refused>"));
  }
  std::string toServer(std::string_view packet) { return toServer(packet, home); }
  std::string toClient(std::string_view packet) {
    return std::string(client.open(server_path, packet, now).value_or("<refused>"));
  }
  /// Validates `path`: the client sends from it, is challenged, and answers from it.
  void settle(const Path& path) {
    toServer(fromClient("here"), path);
    toClient(fromServer("who?"));
    toServer(fromClient("me"), path);
  }

  AeadId aead;
  SplitMix64 random{77};
  Time now{std::chrono::hours(1)};
  Path home = pathFrom("198.51.100.7");
  Path server_path{.local = {}, .remote = *makeEndpoint("192.0.2.1", 9876)};
  SealedLink client;
  SealedLink server;
};

/// A test with a pair of its own.
struct LinkFixture : testing::Test, LinkPair {};

}  // namespace naiad::test
