#include <gtest/gtest.h>

#include "client/terminal/AsciiFallback.h"
#include "client/ui/ScreenLayout.h"

namespace naiad {
namespace {

using namespace std::chrono_literals;

ScreenModel model(int width = 80, int height = 24) {
  ScreenModel m;
  m.view = df::Canvas(width, height);
  m.view.put(0, 0, {U'A', df::RED});
  m.view.put(width - 1, height - 1, {U'Z', df::BLUE});
  m.focus = {width / 2, height / 2};
  m.has_view = true;
  m.round_trip = 42ms;
  m.game = "saucershoot";
  m.server = "dfserver 0.1";
  m.players = {{1, "Ada", df::CYAN, 30, 42}, {2, "Bob", df::GREEN, 70, 8}};
  m.self = 1;
  return m;
}

/// Returns the first row with this text; −1 if there is none.
int rowWith(const ScreenBuffer& picture, const std::string& text) {
  for (int y = 0; y < picture.height(); ++y) {
    if (picture.rowText(y).find(text) != std::string::npos) return y;
  }
  return -1;
}

bool contains(const ScreenBuffer& picture, const std::string& text) {
  return rowWith(picture, text) >= 0;
}

class ScreenLayoutTest : public testing::Test {
 protected:
  ScreenLayout compose(int columns = 80, int rows = 24) const { return composeScreen(m, columns, rows); }
  ScreenBuffer drawn(int columns = 80, int rows = 24) const { return compose(columns, rows).picture; }
  bool shows(const std::string& text, int columns = 80, int rows = 24) const {
    return contains(drawn(columns, rows), text);
  }

  ScreenModel m = model();
};

TEST_F(ScreenLayoutTest, RoomListShowsPlayersAndHighlightsTheChosenRoom) {
  m.panel = Panel::kRooms;
  m.room = "lobby";
  m.rooms = {{"lobby", "lobby", 2, 64, false}, {"arcade", "saucershoot", 0, 8, true}};
  m.room_choice = 1;
  const ScreenLayout layout = compose();
  EXPECT_EQ(layout.shown.rooms, 2);
  EXPECT_TRUE(contains(layout.picture, "* lobby "));
  EXPECT_TRUE(contains(layout.picture, "arcade           saucershoot         0/8    asleep"));
  const int y = rowWith(layout.picture, "arcade");
  for (int x = 0; x < 80; ++x) {
    if (layout.picture.at(x, y).ch != U'a') continue;
    EXPECT_EQ(layout.picture.at(x, y).style, Style::kReverse);
  }
}

TEST_F(ScreenLayoutTest, MoreRoomsThanFitShowTheChosenOne) {
  m.panel = Panel::kRooms;
  m.room = "room-0";
  for (int i = 0; i < 64; ++i) m.rooms.push_back({"room-" + std::to_string(i), "hello", 0, 8, false});
  for (int choice = 0; choice < 64; ++choice) {
    m.room_choice = choice;
    EXPECT_TRUE(shows("room-" + std::to_string(choice) + " ")) << choice;
  }
}

TEST_F(ScreenLayoutTest, PanelSaysThatTheServerHasNoRooms) {
  m.panel = Panel::kRooms;
  EXPECT_TRUE(shows("This server has no rooms."));
}

TEST_F(ScreenLayoutTest, LargeTerminalCentresAndFramesTheView) {
  const ScreenLayout layout = compose(100, 30);
  const ViewPlacement& place = layout.placement;
  EXPECT_TRUE(place.framed);
  EXPECT_TRUE(place.status_row);
  EXPECT_EQ(place.left, 10);
  EXPECT_EQ(place.top, 2);
  EXPECT_EQ(layout.picture.at(10, 2).ch, U'A');
  EXPECT_EQ(layout.picture.at(89, 25).ch, U'Z');
  EXPECT_EQ(layout.picture.at(9, 1).ch, U'┌');
  EXPECT_EQ(layout.picture.at(90, 26).ch, U'┘');
  EXPECT_NE(layout.picture.rowText(29).find("42 ms   2 players"), std::string::npos);
  EXPECT_NE(layout.picture.rowText(29).find("Ctrl-G help"), std::string::npos);
}

TEST_F(ScreenLayoutTest, HintsNameTheMenuKey) {
  m.panel = Panel::kHelp;
  m.menu_letter = 'X';
  for (const auto& [columns, rows] : {std::pair{100, 30}, {80, 24}, {92, 24}, {120, 24}}) {
    const ScreenBuffer picture = drawn(columns, rows);
    EXPECT_TRUE(contains(picture, "Ctrl-X h")) << columns;
    EXPECT_FALSE(contains(picture, "Ctrl-G")) << columns;
  }
}

TEST_F(ScreenLayoutTest, StatusOverlaysBlankCellsWhenTerminalEqualsView) {
  const ScreenLayout layout = compose();
  EXPECT_FALSE(layout.placement.framed);
  EXPECT_FALSE(layout.placement.status_row);
  EXPECT_TRUE(layout.shown.status);
  EXPECT_EQ(layout.picture.at(0, 0).ch, U'A');
  EXPECT_EQ(layout.picture.at(79, 23).ch, U'Z') << "a corner that the game uses is the game's";
  EXPECT_NE(layout.picture.rowText(0).find(" 42 ms  2 players  Ctrl-G help "), std::string::npos);
  m.view.put(79, 0, {U'Y', df::BLUE});
  EXPECT_NE(drawn().rowText(23).find(" 42 ms  2 players"), std::string::npos);
  EXPECT_EQ(drawn().at(79, 23).ch, U'Z') << "on the left";
}

TEST_F(ScreenLayoutTest, StatusOverlayIsTemporaryButStatusRowStays) {
  m.status_over_game = false;
  const ScreenLayout layout = compose();
  EXPECT_FALSE(layout.shown.status);
  EXPECT_FALSE(contains(layout.picture, "42 ms"));
  for (int y = 0; y < 24; ++y) {
    for (int x = 0; x < 80; ++x) EXPECT_EQ(layout.picture.at(x, y).ch, m.view.at(x, y).ch) << x << ' ' << y;
  }
  EXPECT_TRUE(shows("42 ms", 80, 25)) << "where it covers nothing it stays";
  m.status_shown = false;
  EXPECT_FALSE(shows("42 ms", 80, 25));
}

TEST_F(ScreenLayoutTest, SideColumnsHoldTheStatusWithoutASpareRow) {
  m.status_over_game = false;
  m.note = "sound: fire";
  const ScreenLayout layout = compose(92, 24);
  EXPECT_TRUE(layout.placement.status_side);
  EXPECT_TRUE(layout.shown.status);
  EXPECT_EQ(layout.placement.width, 80);
  EXPECT_EQ(layout.picture.at(layout.placement.left, 0).ch, U'A');
  EXPECT_EQ(layout.picture.at(layout.placement.left + 79, 23).ch, U'Z');
  for (const char* text : {"42 ms", "2 players", "Ctrl-G h", "sound: fir"})
    EXPECT_TRUE(contains(layout.picture, text)) << text;
  EXPECT_FALSE(compose(90, 24).placement.status_side);
}

TEST_F(ScreenLayoutTest, StatusHasNoEmptyCountsAndNoTicks) {
  struct Case {
    int players;
    std::int32_t own_score, other_score;
    const char *row, *corner, *side;
  };
  const Case cases[] = {
      {0, 0, 0, " 42 ms ", " 42 ms  Ctrl", ""},
      {1, 0, 0, " 42 ms   1 player ", " 42 ms  1 player  Ctrl", "1 player"},
      {1, 1, 0, " 42 ms   1 player   1 point ", " 42 ms  1 player  Ctrl", "1 pt "},
      {2, 0, 5, " 42 ms   2 players   0 points ", " 42 ms  2 players  Ctrl", "0 pts"},
      {2, -1, 0, " 42 ms   2 players   -1 points ", " 42 ms  2 players  Ctrl", "-1 pts"},
      {2, 0, 0, " 42 ms   2 players ", " 42 ms  2 players  Ctrl", "2 players"},
  };
  for (const Case& c : cases) {
    m = model();
    m.self_name.clear();
    m.players.clear();
    m.score = c.own_score;
    for (int i = 0; i < c.players; ++i)
      m.players.push_back(
          {m.self + static_cast<unsigned>(i), "p", df::RED, i == 0 ? c.own_score : c.other_score, 5});
    const std::string row = drawn(80, 25).rowText(24);
    EXPECT_EQ(row.rfind(c.row, 0), 0u) << row;
    EXPECT_EQ(row.find("tick"), std::string::npos) << row;
    EXPECT_EQ(row.find("point") != std::string::npos, std::string(c.row).find("point") != std::string::npos)
        << row;
    EXPECT_TRUE(shows(c.corner)) << c.corner;
    EXPECT_TRUE(shows(c.side, 92, 24)) << c.side;
    m.panel = Panel::kPlayers;
    EXPECT_EQ(shows("points"), row.find("point") != std::string::npos) << row;
  }
}

TEST_F(ScreenLayoutTest, ANoteIsInTheStatusLine) {
  m.note = "sound: fire";
  const std::string row = drawn(80, 25).rowText(24);
  EXPECT_NE(row.find("sound: fire  Ctrl-G help"), std::string::npos) << row;
  EXPECT_NE(row.find("42 ms   2 players"), std::string::npos) << row;
  EXPECT_NE(drawn().rowText(0).find(" sound: fire  42 ms"), std::string::npos);
  m.note = "music: " + std::string(40, 'x');
  EXPECT_NE(drawn().rowText(0).find(" music: " + std::string(13, 'x') + "  42 ms"), std::string::npos)
      << "it stays short";
  m.status_over_game = false;
  EXPECT_NE(drawn().rowText(0).find(" music: xxx"), std::string::npos) << "where the game shows nothing";
  for (int x = 0; x < 80; ++x) {
    m.view.put(x, 0, {U'=', df::RED});
    m.view.put(x, 23, {U'=', df::RED});
  }
  EXPECT_FALSE(shows("music")) << "it must not cover the game";
  m.status_shown = false;
  EXPECT_FALSE(shows("music", 100, 30));
}

TEST_F(ScreenLayoutTest, TheBackgroundIsBehindTheViewAndNowhereElse) {
  m.background = df::BLUE;
  const ScreenBuffer picture = drawn(100, 30);
  EXPECT_EQ(picture.background(), df::BLUE);
  EXPECT_EQ(picture.at(10, 2).background, df::BLUE) << "behind a character";
  EXPECT_EQ(picture.at(50, 12).background, df::BLUE) << "and behind none";
  EXPECT_EQ(picture.at(9, 1).background, df::BLACK) << "not behind the frame";
  EXPECT_EQ(picture.at(0, 0).background, df::BLACK);
  EXPECT_EQ(picture.at(3, 29).background, df::BLACK) << "nor behind the status line";
  EXPECT_EQ(composeScreen(model(), 100, 30).picture.background(), df::BLACK);
}

TEST_F(ScreenLayoutTest, SmallTerminalCropsTheViewAroundTheFocus) {
  m.focus = {70, 20};
  const ScreenLayout layout = compose(40, 12);
  EXPECT_EQ(layout.placement.view_x, 40);
  EXPECT_EQ(layout.placement.view_y, 12);
  EXPECT_EQ(layout.placement.toView(0, 0), (CellPosition{40, 12}));
  m.focus = {0, 0};
  EXPECT_EQ(compose(40, 12).placement.toView(3, 4), (CellPosition{3, 4}));
}

TEST_F(ScreenLayoutTest, MouseBesideTheViewHitsNothing) {
  const ViewPlacement place = compose(100, 30).placement;
  EXPECT_EQ(place.toView(9, 5), std::nullopt);
  EXPECT_EQ(place.toView(10, 2), (CellPosition{0, 0}));
  EXPECT_EQ(place.toView(89, 25), (CellPosition{79, 23}));
  EXPECT_EQ(place.toView(90, 25), std::nullopt);
}

TEST_F(ScreenLayoutTest, TooSmallTerminalSaysSo) {
  EXPECT_TRUE(shows("Terminal too small", 19, 10));
  EXPECT_TRUE(shows("80x9, needs 20x10", 80, 9));
  EXPECT_TRUE(shows("too small", 10, 3)) << "in few words where there is no room";
  EXPECT_FALSE(shows("small", 20, 10));
}

TEST_F(ScreenLayoutTest, AnySizeIsSafe) {
  m.help = {"Space fires."};
  m.self_name = "Ada";
  m.banner = "Connection lost, reconnecting: 1.0 s";
  m.note = "sound: fire";
  m.chat = {{"Ada", df::CYAN, std::string(200, 'x'), {}}};
  m.chat_text = std::string(200, 'y');
  constexpr Panel kPanels[] = {Panel::kNone, Panel::kPlayers, Panel::kHelp};
  for (int mix = 0; mix < 6; ++mix) {
    m.panel = kPanels[mix % 3];
    m.chat_open = mix < 3;
    m.self_cell = CellPosition{mix % 2 == 0 ? -1 : 80, 12 * (mix % 3) - 1};  // outside of the view
    for (int columns = 0; columns < 120; columns += 7) {
      for (int rows = 0; rows < 40; rows += 3) {
        const ScreenBuffer picture = drawn(columns, rows);
        EXPECT_EQ(picture.width(), columns);
        const CellPosition cursor = picture.cursor.value_or(CellPosition{-1, -1});
        EXPECT_TRUE(cursor.x < columns && cursor.y < rows) << columns << " x " << rows;
      }
    }
  }
}

TEST_F(ScreenLayoutTest, PlayersAreListedByScore) {
  m.panel = Panel::kPlayers;
  const ScreenBuffer picture = drawn(100, 30);
  const int bob = rowWith(picture, "Bob");
  EXPECT_GE(bob, 0);
  EXPECT_EQ(rowWith(picture, "Ada"), bob + 1);
  EXPECT_TRUE(contains(picture, "70"));
}

TEST_F(ScreenLayoutTest, HelpShowsGameLinesClientKeysAndReleaseReporting) {
  m.panel = Panel::kHelp;
  m.help = {"Space fires."};
  const ScreenBuffer picture = drawn();
  for (const char* text : {"Space fires.", "leave the game", "guessed"})
    EXPECT_TRUE(contains(picture, text)) << text;
  m.key_releases = true;
  EXPECT_TRUE(shows("exact"));
}

TEST_F(ScreenLayoutTest, HelpWrapsInANarrowTerminal) {
  m.panel = Panel::kHelp;
  // 76 characters, the limit of a server's line.
  m.help = {"This line of the game is as long as any can be, and here is its very end: END",
            "arrows or WASD   move the paddle, which is yours alone, and hold it where you want"};
  for (const int columns : {80, 76, 60, 40}) {
    const ScreenLayout layout = compose(columns, 40);
    EXPECT_EQ(layout.shown.max_scroll, 0) << columns;
    for (const char* text : {"END", "want", "Esc closes", "close the help"})
      EXPECT_TRUE(contains(layout.picture, text)) << columns << text;
  }
}

TEST_F(ScreenLayoutTest, WrappedHelpLinesAlignUnderTheirText) {
  m.panel = Panel::kHelp;
  const ScreenBuffer picture = drawn(50, 40);
  // "Ctrl-G t   say something to all players (or Ctrl-G c)"
  const int row = rowWith(picture, "say something");
  ASSERT_TRUE(row >= 0 && row < 39);
  const std::u32string first = df::decodeUtf8(picture.rowText(row));
  const std::u32string next = df::decodeUtf8(picture.rowText(row + 1));
  EXPECT_EQ(next.find(U"Ctrl-G c"), first.find(U"say")) << picture.rowText(row + 1);
}

TEST_F(ScreenLayoutTest, HelpThatDoesNotFitScrollsAndSaysSo) {
  m.panel = Panel::kHelp;
  for (int i = 0; i < 24; ++i) m.help.push_back("line " + std::to_string(i) + ".");
  ScreenLayout layout = compose(76, 24);
  EXPECT_TRUE(contains(layout.picture, "line 0."));
  EXPECT_FALSE(contains(layout.picture, "close the help"));
  EXPECT_TRUE(contains(layout.picture, "Down"));
  EXPECT_TRUE(contains(layout.picture, "Esc closes"));
  EXPECT_EQ(layout.shown.max_scroll, 24 + 1 + 11 - 22);
  EXPECT_EQ(layout.shown.page, 22);
  m.scroll = layout.shown.max_scroll;
  layout = compose(76, 24);
  EXPECT_FALSE(contains(layout.picture, "line 0."));
  EXPECT_TRUE(contains(layout.picture, "close the help"));
  m.scroll = 1000;  // left over from a smaller terminal
  EXPECT_TRUE(shows("close the help", 76, 24));
  EXPECT_TRUE(shows("Down", 20, 10));
}

TEST_F(ScreenLayoutTest, PlayerListScrollsUnderItsHeader) {
  m.panel = Panel::kPlayers;
  for (std::uint32_t i = 0; i < 64; ++i)
    m.players.push_back({10 + i, "p" + std::to_string(i), df::RED, -1, 5});
  ScreenLayout layout = compose();
  EXPECT_FALSE(contains(layout.picture, "p63"));
  EXPECT_TRUE(contains(layout.picture, "Esc closes"));
  m.scroll = layout.shown.max_scroll;
  layout = compose();
  EXPECT_TRUE(contains(layout.picture, "p63"));
  EXPECT_TRUE(contains(layout.picture, "points"));
  EXPECT_FALSE(contains(layout.picture, "Bob"));
}

TEST_F(ScreenLayoutTest, ChatLineShowsTheEndOfALongText) {
  m.chat_open = true;
  m.chat_text = std::string(100, 'a') + "END";
  m.chat = {{"Bob", df::GREEN, "hi there", {}}, {"", df::WHITE, "Ada joined", {}}};
  const ScreenLayout layout = compose(80, 25);
  EXPECT_NE(layout.picture.rowText(23).find("aEND"), std::string::npos);
  EXPECT_EQ(layout.picture.cursor, (CellPosition{79, 23}));
  EXPECT_EQ(layout.picture.rowText(22).substr(0, 12), "* Ada joined");
  EXPECT_EQ(layout.picture.rowText(21).substr(0, 13), "Bob: hi there");
  EXPECT_EQ(layout.picture.at(0, 21).color, df::GREEN);
}

TEST(AsciiFallback, MapsACharacterToASimilarOne) {
  EXPECT_EQ(asciiFor(U'a'), 'a');
  EXPECT_EQ(asciiFor(U'─'), '-');
  EXPECT_EQ(asciiFor(U'│'), '|');
  EXPECT_EQ(asciiFor(U'┌'), '+');
  EXPECT_EQ(asciiFor(U'█'), '#');
  EXPECT_EQ(asciiFor(U'▲'), '^');
  EXPECT_EQ(asciiFor(U'é'), 'e');
  EXPECT_EQ(asciiFor(U'Ж'), '?');
}

/// True if the text is there in this colour and style.
bool containsIn(const ScreenBuffer& picture, const std::string& text, df::Color color, Style style) {
  const int y = rowWith(picture, text);
  if (y < 0) return false;
  const ScreenCell cell = picture.at(static_cast<int>(picture.rowText(y).find(text)), y);
  return cell.color == color && cell.style == style;
}

TEST_F(ScreenLayoutTest, StatusLineBeginsWithTheColouredPlayerName) {
  m.self_name = "Ada";
  m.self_color = df::CYAN;
  const ScreenBuffer picture = drawn(100, 30);
  EXPECT_EQ(picture.rowText(29).rfind("  Ada   42 ms   2 players", 0), 0u) << picture.rowText(29);
  EXPECT_EQ(picture.at(2, 29).color, df::CYAN);
  EXPECT_EQ(picture.at(2, 29).style, Style::kReverse);
  EXPECT_TRUE(containsIn(drawn(92, 24), "Ada", df::CYAN, Style::kBold)) << "beside the view";
}

TEST_F(ScreenLayoutTest, APointerShowsThePlayersOwnObject) {
  m.self_name = "Ada";
  m.self_color = df::CYAN;
  m.self_cell = CellPosition{40, 12};
  ScreenBuffer picture = drawn();
  EXPECT_EQ(picture.at(40, 10).ch, U'▼');
  EXPECT_EQ(picture.at(40, 12).ch, U' ') << "the object itself is not covered";
  EXPECT_TRUE(containsIn(picture, " you: Ada ", df::CYAN, Style::kReverse));
  m.self_cell = CellPosition{0, 0};
  picture = drawn();
  EXPECT_EQ(picture.at(0, 2).ch, U'▲');
  EXPECT_EQ(picture.rowText(3).rfind(" you: Ada ", 0), 0u);
}

TEST_F(ScreenLayoutTest, WideTerminalShowsPlayersChatAndHelpPanels) {
  m.help = {"Arrows   fly", "Space    shoot"};
  m.history = {{"Bob", df::GREEN, "hi there", {}}, {"", df::WHITE, "Ada joined", {}}};
  m.chat = m.history;
  const ScreenLayout layout = compose(140, 40);
  EXPECT_EQ(layout.placement.width, 80);
  EXPECT_EQ(layout.placement.height, 24);
  EXPECT_TRUE(layout.placement.framed);
  EXPECT_LT(layout.placement.left + 80, 140 - 40);
  for (const char* p_part :
       {"Players ─", "Chat ─", "Help ─", "Arrows   fly", "Ctrl-G h   all keys", "* Ada joined"})
    EXPECT_TRUE(contains(layout.picture, p_part)) << p_part;
  EXPECT_TRUE(containsIn(layout.picture, "Ada", df::CYAN, Style::kBold));
  EXPECT_TRUE(contains(layout.picture, "Bob: hi there"));
  EXPECT_EQ(layout.picture.rowText(38).find("Ada joined"), std::string::npos) << "not over the game as well";
  m.status_shown = false;
  EXPECT_FALSE(shows("Chat ─", 140, 40)) << "s takes it away, too";
  m.status_shown = true;
  EXPECT_FALSE(shows("Chat ─", 107, 40)) << "no room";
}

TEST_F(ScreenLayoutTest, ChatScrollsBackOverTheGameAndBesideIt) {
  m.chat_open = true;
  for (int i = 0; i < 100; ++i) m.chat.push_back({"Bob", df::GREEN, "line " + std::to_string(i) + ".", {}});
  m.history = m.chat;
  for (const int columns : {80, 140}) {
    m.chat_scroll = 0;
    ScreenLayout layout = compose(columns, 40);
    EXPECT_TRUE(contains(layout.picture, "line 99.")) << columns;
    EXPECT_FALSE(contains(layout.picture, "line 50.")) << columns;
    while (m.chat_scroll < layout.shown.max_chat_scroll) {
      m.chat_scroll = layout.shown.max_chat_scroll;
      layout = compose(columns, 40);
    }
    EXPECT_TRUE(contains(layout.picture, "line 0.")) << columns;
    EXPECT_FALSE(contains(layout.picture, "line 99.")) << columns;
    EXPECT_TRUE(contains(layout.picture, "say: "));
  }
}

TEST_F(ScreenLayoutTest, ManyPlayersAndLongTextsFitTheSidePanel) {
  m.help.assign(40, std::string(300, 'h'));
  m.players.clear();
  for (std::uint32_t i = 1; i <= 200; ++i)
    m.players.push_back({i, "player" + std::to_string(i), df::GREEN, static_cast<int>(i), 1});
  m.history.assign(200, {"Bob", df::GREEN, std::string(250, 'x'), {}});
  for (const int rows : {20, 24, 25, 60, 150}) {
    for (const bool open : {false, true}) {
      m.chat_open = open;
      const ScreenBuffer picture = drawn(130, rows);
      EXPECT_EQ(picture.height(), rows);
      if (rows > 24) {
        EXPECT_TRUE(contains(picture, "player200")) << rows;
        EXPECT_TRUE(contains(picture, " more")) << rows;
      }
    }
  }
}

}  // namespace
}  // namespace naiad
