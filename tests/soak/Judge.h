// Compares the pictures of clients with those of the server.
//
// A picture counts if its client has received everything that the server sent until that tick. The client
// cannot know this, because content of a lost snapshot may not yet have been sent again. So the server is
// asked, like for the protocol's checksum, with the exact snapshots received. While it cannot decide, the
// picture waits.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <string>
#include <unordered_map>

#include "Bot.h"
#include "Tally.h"
#include "VirtualHost.h"
#include "shared/values/Canvas.h"

namespace naiad::soak {

class Judge {
 public:
  /// Compares every `stride`-th tick of each player.
  Judge(const df::World& world, const VirtualHost& host, Tally& tally, std::uint32_t stride)
      : m_world(world), m_host(host), m_tally(tally), m_stride(stride) {}

  /// Compares every tick from now on.
  void lookAtAll() { m_stride = 1; }
  /// Records the pictures of the world's present tick. Call before its snapshots are sent.
  void keepTruths();
  /// Compares a client's picture. Call after the client has applied a snapshot.
  void look(Bot& bot, const SnapshotHeader& header, const AckWindow& acks);
  /// Judges the waiting pictures. Call once a tick.
  void judge();
  /// Returns how many of this player's latest pictures in a row were right.
  std::uint64_t rightInARow(std::uint32_t player) const;
  /// Returns the bytes that this Judge uses, which measurements of the game's memory must subtract.
  std::size_t bytesKept() const;

 private:
  static constexpr std::uint32_t kTruths = 48;  ///< ticks recorded per player

  struct Truth {
    std::uint32_t tick = 0;
    df::Canvas picture;
  };
  struct Waiting {
    AckWindow acks;
    std::uint64_t checksum = 0;
    std::uint32_t tick = 0;
    int wrong = 0;
    int cells = 0;
    int age = 0;
    std::string text;  ///< describes a wrong picture for people
  };
  struct Account {
    std::array<Truth, kTruths> truths;
    std::deque<Waiting> waiting;
    std::uint64_t right_in_a_row = 0;
  };

  bool isDue(std::uint32_t tick, std::uint32_t player) const { return tick % m_stride == player % m_stride; }
  bool settle(std::uint32_t player, Account& account, const Waiting& waiting);

  const df::World& m_world;
  const VirtualHost& m_host;
  Tally& m_tally;
  std::uint32_t m_stride;
  std::unordered_map<std::uint32_t, Account> m_accounts;
  int m_described = 0;
};

}  // namespace naiad::soak
