// Players walk about in the shipped lobby and into its first door.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <utility>

#include "RoomsFixture.h"

namespace naiad::test {

inline constexpr int kDoorColumn = 10;  ///< middle column of the first door
inline constexpr int kDoorRow = 6;
inline constexpr int kFirstRow = 2;  ///< row where players appear
inline constexpr int kRows = 24;

class LobbyFixture : public RoomsFixture {
 protected:
  using Place = std::pair<int, int>;

  /// Returns the position of the first player shown in these rows; nullopt if none is there.
  static std::optional<Place> walker(TestClient& client, int first, int last) {
    const df::Canvas picture = client.session().replica().render(client.newestTick());
    for (int y = first; y <= last; ++y) {
      const std::size_t x = picture.rowText(y).find('@');
      if (x != std::string::npos) return Place(static_cast<int>(x), y);
    }
    return std::nullopt;
  }
  /// Makes one step. Waits four ticks, because the lobby allows a step only every second tick.
  void step(TestClient& client, df::Keyboard::Key key) {
    const auto before = walker(client, kFirstRow, kRows - 1);
    ASSERT_TRUE(before);
    press(client, key);
    ASSERT_TRUE(serve([&] { return walker(client, kFirstRow, kRows - 1) != before; }));
    const std::uint32_t moved = client.newestTick();
    ASSERT_TRUE(serve([&] { return client.newestTick() >= moved + 4; }));
  }
  /// Walks to the cell from which one more step down leads into the door.
  void walkToDoor(TestClient& client) {
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->first > kDoorColumn)
      step(client, df::Keyboard::LEFTARROW);
    while (!HasFatalFailure() && walker(client, kFirstRow, kDoorRow - 1)->second < kDoorRow - 1)
      step(client, df::Keyboard::DOWNARROW);
  }
};

}  // namespace naiad::test
