// Where objects were on a client's screen: the published motions of the last ticks, and the players' views.
//
// All clients extrapolate the same published models, so what one drew follows from two ticks: the newest it
// had heard of, and the one it drew. What is too long ago does not count: a player may be slow, not late by
// choice.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "engine/world/LagCompensation.h"
#include "host/snapshot/Publisher.h"
#include "shared/replica/ViewFollow.h"

namespace naiad {

class LagCompensator : public df::LagCompensation {
 public:
  /// Ticks whose models are kept; who heard of none of them is taken to know the oldest.
  static constexpr std::uint32_t kTicks = 32;
  /// A tick drawn is taken to be one of this many before the present one, or that itself.
  static constexpr std::uint32_t kMaxBehind = 8;

  /// Take in one tick, after Publisher::update() with this view. Ticks left out empty the memory.
  void note(const Publisher& publisher, const df::WorldView& view);

  /// By the published models, drawn characters may be off by what the publisher tolerates: no cell.
  std::optional<df::FixedVector> positionOf(df::ObjectKey object, const df::ViewedTick& seen) const override;
  /// Right to the cell while what the view follows moves on a straight path. Nothing if the player steers by
  /// declared controls what his view follows: his client draws both ahead, as they are when the input
  /// arrives.
  std::optional<df::FixedVector> viewCornerOf(std::uint32_t player,
                                              const df::ViewedTick& seen) const override;

 private:
  struct Known {
    std::uint32_t since;  ///< the tick from which clients could know it
    Motion motion;
  };
  struct History {
    std::uint32_t generation = 0;  ///< 0: nobody
    std::uint32_t born = 0;
    std::deque<Known> motions;  ///< oldest first, never empty while somebody is here
  };

  /// A player's view at the end of a tick, and how what it follows moves on, as far as clients know.
  struct PlayerView {
    std::uint32_t player;
    df::FixedVector corner;
    std::optional<Motion> followed;
  };
  struct Views {
    std::uint32_t tick = 0;
    df::FixedVector size;
    df::FixedBox boundary;
    std::vector<PlayerView> players;  ///< by player
  };

  std::uint32_t baseOf(const df::ViewedTick& seen) const;
  std::uint32_t drawnOf(const df::ViewedTick& seen) const;
  void noteViews(const Publisher& publisher, const df::WorldView& view);
  void learn(std::uint32_t slot, const Publisher::Model& model, bool moved);
  void forget(std::uint32_t slot);

  std::vector<History> m_histories;  ///< by slot
  std::array<Views, kTicks + 1> m_views;
  std::uint32_t m_tick = 0;
  bool m_began = false;
};

/// Which tick each of the last snapshots to one client was of.
class SnapshotTicks {
 public:
  /// Snapshot `number` of `tick` was sent.
  void note(std::uint32_t number, std::uint32_t tick) { m_sent[number % kKept] = {number, tick}; }
  /// The tick of this snapshot; nothing for one that was not sent, or long ago.
  std::optional<std::uint32_t> tickOf(std::uint32_t number) const {
    const Sent& sent = m_sent[number % kKept];
    return number != 0 && sent.number == number ? std::optional(sent.tick) : std::nullopt;
  }

 private:
  static constexpr std::size_t kKept = 128;
  struct Sent {
    std::uint32_t number = 0;
    std::uint32_t tick = 0;
  };
  std::array<Sent, kKept> m_sent{};
};

}  // namespace naiad
