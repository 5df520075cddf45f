// Who plays, told to all who play: now and then, and bounded however many they are.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "engine/world/WorldView.h"
#include "naiad.pb.h"

namespace naiad {

/// Up to kMaxPlayers all hear of all, every half second if anything is new. In a larger crowd each hears
/// every five seconds of those with the highest scores and of himself: his list stays a screenful, and what
/// all lists cost grows with the crowd, not with its square. Not thread-safe.
class PlayerNews {
 public:
  static constexpr std::uint32_t kEvery = 15;        ///< ticks
  static constexpr std::uint32_t kCrowdEvery = 150;  ///< ticks
  static constexpr std::size_t kCrowdEntries = 32;

  /// Round trip of a player in milliseconds; 0: not known.
  using RoundTrip = std::function<std::uint32_t(std::uint32_t player)>;
  using Tell = std::function<void(std::uint32_t player, const wire::ServerMessage& message)>;

  /// The end of a tick: call `tell` for everybody who is to hear something now.
  void tick(std::uint32_t tick, const std::vector<df::PlayerFacts>& players, const RoundTrip& round_trip,
            const Tell& tell);
  /// Somebody may have missed what was told: tell it again although nothing is new.
  void repeat() { m_told.clear(); }

 private:
  void tellAll(const std::vector<df::PlayerFacts>& players, const RoundTrip& round_trip, const Tell& tell);
  void tellSome(std::uint32_t tick, const std::vector<df::PlayerFacts>& players, const RoundTrip& round_trip,
                const Tell& tell);

  std::string m_told;          ///< as last sent to all, serialised
  wire::ServerMessage m_best;  ///< of a crowd
};

}  // namespace naiad
