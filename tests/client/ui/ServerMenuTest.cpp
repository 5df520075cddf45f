#include <gtest/gtest.h>

#include "client/ui/ServerMenu.h"
#include "shared/net/base/Limits.h"

namespace naiad {
namespace {

namespace key = df::Keyboard;
using MenuResult = ServerMenu::Result;

DiscoveredServer menuServer(unsigned number, const std::string& name) {
  DiscoveredServer server;
  server.name = name;
  server.game = "hello";
  server.address = {"192.168.1." + std::to_string(number), 9876};
  ShortKey::Bytes bytes{};
  bytes[0] = static_cast<std::uint8_t>(number);
  server.key = ShortKey::ofBytes(bytes);
  server.protocol = kProtocolVersion;
  server.max_players = 16;
  return server;
}

std::vector<DiscoveredServer> menuServers(unsigned count) {
  std::vector<DiscoveredServer> servers;
  for (unsigned i = 1; i <= count; ++i) servers.push_back(menuServer(i, "server " + std::to_string(i)));
  return servers;
}

std::string textOf(const ScreenBuffer& picture) {
  std::string text;
  for (int y = 0; y < picture.height(); ++y) text += picture.rowText(y) + "\n";
  return text;
}

bool shows(ServerMenu& menu, const std::string& text, int columns = 80, int rows = 24) {
  return textOf(menu.compose(columns, rows)).find(text) != std::string::npos;
}

MenuResult press(ServerMenu& menu, key::Key which, std::uint8_t modifiers = 0) {
  KeyEvent event;
  event.key = which;
  event.modifiers = modifiers;
  return menu.handleKey(event);
}

ServerMenu menuOf(std::vector<DiscoveredServer> servers) {
  ServerMenu menu("Servers in this network");
  menu.setEmpty({"No server answered.", "Start one."});
  menu.setServers(std::move(servers));
  menu.setSearching(false);
  return menu;
}

TEST(ServerMenu, ShowsNameGamePlayersAndAddress) {
  ServerMenu menu = menuOf({menuServer(5, "Ann's")});
  for (const char* p_text :
       {"Servers in this network", "Ann's", "hello", "0/16", "192.168.1.5:9876", "Enter join"})
    EXPECT_TRUE(shows(menu, p_text)) << textOf(menu.compose(80, 24));
}

TEST(ServerMenu, ArrowsChooseAndEnterJoins) {
  ServerMenu menu = menuOf(menuServers(3));
  EXPECT_EQ(press(menu, key::UPARROW), MenuResult::kRedraw);
  EXPECT_EQ(menu.chosen()->name, "server 1");
  press(menu, key::DOWNARROW);
  press(menu, key::DOWNARROW);
  press(menu, key::DOWNARROW);
  EXPECT_EQ(menu.chosen()->name, "server 3");
  press(menu, key::UPARROW);
  EXPECT_EQ(press(menu, key::RETURN), MenuResult::kJoin);
  EXPECT_EQ(menu.chosen()->name, "server 2");
}

TEST(ServerMenu, OtherKeysRefreshAndLeave) {
  ServerMenu menu = menuOf(menuServers(1));
  EXPECT_EQ(press(menu, key::R), MenuResult::kRefresh);
  EXPECT_EQ(press(menu, key::Q), MenuResult::kLeave);
  EXPECT_EQ(press(menu, key::ESCAPE), MenuResult::kLeave);
  EXPECT_EQ(press(menu, key::C, kControl), MenuResult::kLeave);
  EXPECT_EQ(press(menu, key::Z, kControl), MenuResult::kSuspend);
  EXPECT_EQ(press(menu, key::X), MenuResult::kNone);
  KeyEvent release;
  release.key = key::RETURN;
  release.action = KeyEvent::Action::kRelease;
  EXPECT_EQ(menu.handleKey(release), MenuResult::kNone);
}

TEST(ServerMenu, SelectionFollowsItsServerWhenTheListChanges) {
  ServerMenu menu = menuOf(menuServers(3));
  press(menu, key::DOWNARROW);
  menu.setServers(
      {menuServer(9, "a"), menuServer(1, "server 1"), menuServer(8, "b"), menuServer(2, "server 2")});
  EXPECT_EQ(menu.chosen()->name, "server 2");
  menu.setServers({menuServer(9, "a")});
  EXPECT_EQ(menu.chosen()->name, "a");
  menu.setServers({});
  EXPECT_EQ(menu.chosen(), nullptr);
  EXPECT_EQ(press(menu, key::RETURN), MenuResult::kNone);
  EXPECT_EQ(press(menu, key::DOWNARROW), MenuResult::kRedraw);
}

TEST(ServerMenu, EmptyListSaysWhatToDoAfterTheSearch) {
  ServerMenu menu = menuOf({});
  EXPECT_TRUE(shows(menu, "No server answered."));
  EXPECT_TRUE(shows(menu, "Start one."));
  menu.setSearching(true);
  EXPECT_TRUE(shows(menu, "Looking"));
  EXPECT_FALSE(shows(menu, "No server answered."));
}

TEST(ServerMenu, AServerOfAnotherVersionIsNotJoined) {
  DiscoveredServer other = menuServer(1, "old");
  other.protocol = kProtocolVersion + 1;
  ServerMenu menu = menuOf({other});
  EXPECT_EQ(press(menu, key::RETURN), MenuResult::kRedraw);
  EXPECT_TRUE(shows(menu, "server protocol version " + std::to_string(kProtocolVersion + 1)));
}

TEST(ServerMenu, LongListScrollsToTheChosenServer) {
  ServerMenu menu = menuOf(menuServers(60));
  EXPECT_TRUE(shows(menu, "server 1 "));
  EXPECT_FALSE(shows(menu, "server 60"));
  press(menu, key::END);
  EXPECT_TRUE(shows(menu, "server 60"));
  EXPECT_FALSE(shows(menu, "server 1 "));
  menu.compose(80, 24);
  press(menu, key::PAGEUP);
  EXPECT_EQ(menu.chosen()->name, "server 42");
  press(menu, key::HOME);
  EXPECT_TRUE(shows(menu, "server 1 "));
}

TEST(ServerMenu, AnySizeOfTerminalCanBeDrawn) {
  for (const unsigned count : {0u, 1u, 60u}) {
    ServerMenu menu = menuOf(menuServers(count));
    for (int columns = 1; columns < 60; ++columns) {
      for (int rows = 1; rows < 12; ++rows) {
        press(menu, key::DOWNARROW);
        EXPECT_EQ(menu.compose(columns, rows).width(), columns);
      }
    }
  }
}

}  // namespace
}  // namespace naiad
