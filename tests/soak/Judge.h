// Holds what clients show against what the server drew.
//
// A picture counts if everything has been sent to its client by then. The client alone cannot know: what a
// lost snapshot said may still be on its way again. So the server is asked, as for the checksum of the
// protocol, with exactly what has arrived; while it cannot tell yet, the picture waits.
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
  /// Looks at every `stride`-th tick of each player.
  Judge(const df::World& world, const VirtualHost& host, Tally& tally, std::uint32_t stride)
      : m_world(world), m_host(host), m_tally(tally), m_stride(stride) {}

  /// From now on look at every tick.
  void lookAtAll() { m_stride = 1; }
  /// Keep the truth about the world's present tick. Before its snapshots are sent.
  void keepTruths();
  /// A client has applied a snapshot.
  void look(Bot& bot, const SnapshotHeader& header, const AckWindow& acks);
  /// Ask about the pictures that wait. Once a tick.
  void judge();
  /// Pictures of this player that were found right, one after the other, up to now.
  std::uint64_t rightInARow(std::uint32_t player) const;
  /// What all this takes, so that it can be left out of the memory that is measured.
  std::size_t bytesKept() const;

 private:
  static constexpr std::uint32_t kTruths = 48;  ///< of each player

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
    std::string text;  ///< for people, if it is wrong
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
