// Players who walk about in the lobby that ships, and into its first door.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "RoomsFixture.h"

namespace naiad::test {

inline constexpr int kDoorColumn = 10;  ///< of the first door, in its middle
inline constexpr int kDoorRow = 6;
inline constexpr int kFirstRow = 2;  ///< where players appear
inline constexpr int kRows = 24;

class LobbyFixture : public RoomsFixture {
 protected:
  using Place = std::pair<int, int>;

  /// Of a player who stands in these rows; nothing if none does.
  static std::optional<Place> walker(TestClient& client, int first, int last) {
    const df::Canvas picture = client.session().replica().render(client.newestTick());
    for (int y = first; y <= last; ++y) {
      const std::size_t x = picture.rowText(y).find('@');
      if (x != std::string::npos) return Place(static_cast<int>(x), y);
    }
    return std::nullopt;
  }
  /// One step, of which the lobby takes one every second tick.
  void step(TestClient& client, df::Keyboard::Key key) {
    const auto before = walker(client, kFirstRow, kRows - 1);
    ASSERT_TRUE(before);
    press(client, key);
    ASSERT_TRUE(serve([&] { return walker(client, kFirstRow, kRows - 1) != before; }));
    const std::uint32_t moved = client.newestTick();
    ASSERT_TRUE(serve([&] { return client.newestTick() >= moved + 4; }));
  }
  /// To where the next step leads into the door.
  void walkToDoor(TestClient& client) {
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->first > kDoorColumn)
      step(client, df::Keyboard::LEFTARROW);
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->second < kDoorRow - 1)
      step(client, df::Keyboard::DOWNARROW);
  }
};

}  // namespace naiad::test
