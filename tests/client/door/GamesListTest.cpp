#include <gtest/gtest.h>

#include "client/door/GamesList.h"

namespace naiad {
namespace {

const std::string kLink = "naiad://127.0.0.1:9877#abcdefghijklmnopqrstuvwxya";

TEST(GamesList, HasOneGamePerLine) {
  const auto list = GamesList::parse("# mine\n\n  saucers\t" + kLink + "  /run/a.visitors\ntron " + kLink +
                                     " /run/b.visitors password\n");
  EXPECT_EQ(list.problem, "");
  ASSERT_EQ(list.games.size(), 2u);
  EXPECT_EQ(list.games[0].name, "saucers");
  EXPECT_EQ(list.games[0].link.text(), kLink);
  EXPECT_EQ(list.games[0].socket, "/run/a.visitors");
  EXPECT_FALSE(list.games[0].needs_password);
  EXPECT_TRUE(list.games[1].needs_password);
}

TEST(GamesList, InvalidLineIsReportedAndNoGamesAreListed) {
  const std::string good = "saucers " + kLink + " /run/a.visitors\n";
  for (const std::string& bad :
       {"tron " + kLink, "tron " + kLink + " relative", "tron " + kLink + " /run/b password more",
        "tron " + kLink + " /run/b pasword", std::string("tron 127.0.0.1:9876 /run/b"),
        "t\033n " + kLink + " /run/b", std::string(33, 'x') + " " + kLink + " /run/b"}) {
    const auto list = GamesList::parse(good + bad + "\n");
    EXPECT_TRUE(list.problem.starts_with("line 2: ")) << bad;
    EXPECT_TRUE(list.games.empty());
    for (const char c : list.problem) EXPECT_GE(static_cast<unsigned char>(c), ' ');
  }
  std::string many;
  for (std::size_t i = 0; i <= GamesList::kMaxGames; ++i) many += good;
  EXPECT_TRUE(GamesList::parse(many).problem.starts_with("line 65: "));
}

}  // namespace
}  // namespace naiad
