// Lag compensation: where objects were on a client's screen, by the published motions of the last ticks and
// the players' views.
//
// All clients extrapolate the same published models, so what a client drew follows from two ticks: the newest
// that it had received, and the one that it drew. Older ticks are clamped, since players must not choose to
// be late.
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
  /// Ticks whose models are kept. A client that received none of them is taken to have the oldest.
  static constexpr std::uint32_t kTicks = 32;
  /// A drawn tick is clamped to the present one and this many before it.
  static constexpr std::uint32_t kMaxBehind = 8;

  /// Take in one tick, after Publisher::update() with this view. A gap between ticks clears the history.
  void recordTick(const Publisher& publisher, const df::WorldView& view);

  /// By the published models, drawn characters may be off by what the publisher tolerates: no cell.
  std::optional<df::FixedVector> positionOf(df::ObjectKey object, const df::ViewedTick& seen) const override;
  /// Right to the cell while what the view follows moves on a straight path. Nothing if the player steers by
  /// declared controls what their view follows: their client draws both ahead, as they are when the input
  /// arrives.
  std::optional<df::FixedVector> viewCornerOf(std::uint32_t player,
                                              const df::ViewedTick& seen) const override;

 private:
  struct Known {
    std::uint32_t since;  ///< the tick from which clients could know it
    Motion motion;
  };
  struct History {
    std::uint32_t generation = 0;  ///< 0: no object
    std::uint32_t born = 0;
    std::deque<Known> motions;  ///< oldest first, never empty while an object is here
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
  void recordViews(const Publisher& publisher, const df::WorldView& view);
  void recordModel(std::uint32_t slot, const Publisher::Model& model, bool moved);
  void clearHistory(std::uint32_t slot);

  std::vector<History> m_histories;  ///< by slot
  std::array<Views, kTicks + 1> m_views;
  std::uint32_t m_tick = 0;
  bool m_has_ticks = false;
};

/// Which tick each of the last snapshots to one client was of.
class SnapshotTicks {
 public:
  /// Snapshot `number` of `tick` was sent.
  void recordSent(std::uint32_t number, std::uint32_t tick) { m_sent[number % kKept] = {number, tick}; }
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
