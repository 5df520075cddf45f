// Lag compensation: computes where objects were on a client's screen, from the published motions and the
// players' views of the last ticks.
//
// All clients extrapolate the published models. So two ticks determine what a client drew: the newest tick
// received and the tick drawn. Too old ticks are clamped, because players must not gain from being late.
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
  /// Ticks whose models are kept. A client whose newest tick is older counts as having received the oldest.
  static constexpr std::uint32_t kTicks = 32;
  /// Maximum age of a drawn tick, in ticks. An older one is clamped to this age, a future one to the present.
  static constexpr std::uint32_t kMaxBehind = 8;

  /// Records one tick. Call after Publisher::update() with this view. A gap between ticks clears the history.
  void recordTick(const Publisher& publisher, const df::WorldView& view);

  /// Uses the published models, whose positions may be inexact, but never enough to draw a wrong cell.
  std::optional<df::FixedVector> positionOf(df::ObjectKey object, const df::ViewedTick& seen) const override;
  /// Exact to the cell while the object that the view follows moves in a straight line. Also returns nullopt
  /// if the player steers that object by declared controls, because the client predicts both.
  std::optional<df::FixedVector> viewCornerOf(std::uint32_t player,
                                              const df::ViewedTick& seen) const override;

 private:
  struct Known {
    std::uint32_t since;  ///< first tick in which clients could know the motion
    Motion motion;
  };
  struct History {
    std::uint32_t generation = 0;  ///< 0: the slot is empty
    std::uint32_t born = 0;
    std::deque<Known> motions;  ///< oldest first; never empty while the slot has an object
  };

  /// A player's view at the end of a tick, and the published motion of the object it follows.
  struct PlayerView {
    std::uint32_t player;
    df::FixedVector corner;
    std::optional<Motion> followed;
  };
  struct Views {
    std::uint32_t tick = 0;
    df::FixedVector size;
    df::FixedBox boundary;
    std::vector<PlayerView> players;  ///< sorted by player id
  };

  std::uint32_t baseOf(const df::ViewedTick& seen) const;
  std::uint32_t drawnOf(const df::ViewedTick& seen) const;
  void recordViews(const Publisher& publisher, const df::WorldView& view);
  void recordModel(std::uint32_t slot, const Publisher::Model& model, bool moved);
  void clearHistory(std::uint32_t slot);

  std::vector<History> m_histories;  ///< indexed by slot
  std::array<Views, kTicks + 1> m_views;
  std::uint32_t m_tick = 0;
  bool m_has_ticks = false;
};

/// The tick of each of the last snapshots to one client.
class SnapshotTicks {
 public:
  /// Records that snapshot `number` of `tick` was sent.
  void recordSent(std::uint32_t number, std::uint32_t tick) { m_sent[number % kKept] = {number, tick}; }
  /// Returns the tick of this snapshot; nullopt if it was not among the last kKept sent.
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
