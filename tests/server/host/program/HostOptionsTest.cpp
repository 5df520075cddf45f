// The command line of dfserver: what would start a server by mistake is an error.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "host/program/HostOptions.h"

namespace naiad {
namespace {

CommandLine parse(const std::vector<const char*>& arguments, HostOptions& options) {
  std::vector<const char*> all = {"dfserver"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return parseHostOptions(static_cast<int>(all.size()), all.data(), options);
}

TEST(HostOptions, AMisspeltOptionInTheConfigFileIsAnError) {
  const std::string path = testing::TempDir() + "naiad_host_options-" + std::to_string(getpid()) + ".ini";
  std::ofstream(path) << "ticks = 3\n";
  HostOptions options;
  EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kRun);
  EXPECT_EQ(options.ticks, 3);
  std::ofstream(path) << "ticsk = 3\n";
  EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kUsageError);
  std::remove(path.c_str());
}

TEST(HostOptions, ATickThatNoClientWouldBelieveIsAnError) {
  HostOptions options;
  EXPECT_EQ(parse({"--frame-time", "999"}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--frame-time", "1000"}, options), CommandLine::kRun);
  EXPECT_EQ(parse({"--frame-time", "0"}, options), CommandLine::kRun);
}

TEST(HostOptions, OneAddressMayHaveAllPlaces) {
  HostOptions options;
  const std::string most = std::to_string(kMaxServerPlayers);
  EXPECT_EQ(parse({"--max-players", most.c_str(), "--max-per-address", most.c_str()}, options),
            CommandLine::kRun);
  EXPECT_EQ(options.max_per_address, options.max_players);
  const std::string more = std::to_string(kMaxServerPlayers + 1);
  EXPECT_EQ(parse({"--max-per-address", more.c_str()}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--max-per-address", "0"}, options), CommandLine::kUsageError);
}

TEST(HostOptions, WhatIsNoneOfTheWordsIsAnError) {
  HostOptions options;
  EXPECT_EQ(parse({"--players", "nobody"}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--players", "first", "--on-game-over", "exit"}, options), CommandLine::kRun);
  EXPECT_EQ(options.players, "first");
  EXPECT_EQ(options.on_game_over, "exit");
}

TEST(HostOptions, WhatIsPrintedForPlayersIsChecked) {
  HostOptions options;
  EXPECT_EQ(parse({"--link-host", "game.example:9877", "--ssh-door", "play@game.example:2222",
                   "--web-address", "https://game.example/play", "--qr"},
                  options),
            CommandLine::kRun);
  const std::vector<std::vector<const char*>> all = {{"--link-host", "a b"},
                                                     {"--link-host", "http://x"},
                                                     {"--ssh-door", "game.example"},
                                                     {"--ssh-door", "a;b@x"},
                                                     {"--ssh-door=-oX@y"},
                                                     {"--ssh-door", "@x"},
                                                     {"--web-address", "ftp://x"},
                                                     {"--web-address", "https://x y"},
                                                     {"--qr"}};
  for (const std::vector<const char*>& bad : all) {
    HostOptions others;
    EXPECT_EQ(parse(bad, others), CommandLine::kUsageError) << bad.front();
  }
}

TEST(HostOptions, ThoseOfProgramsAreNoneOfDfservers) {
  HostOptions options;
  EXPECT_EQ(parse({"--headless"}, options), CommandLine::kUsageError);
}

TEST(HostOptions, APasswordThatEveryUserCanReadIsWarnedOf) {
  namespace fs = std::filesystem;
  const std::string path = testing::TempDir() + "naiad_host_options-" + std::to_string(getpid()) + ".conf";
  const auto warnings = [&path](const std::string& text, fs::perms perms) {
    std::ofstream(path) << text;
    fs::permissions(path, perms);
    HostOptions options;
    EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kRun);
    return options.warnings;
  };
  constexpr fs::perms kOpen = fs::perms::owner_all | fs::perms::others_read;
  EXPECT_EQ(warnings("password = sesame\n", kOpen),
            std::vector<std::string>{path + " has the password, and every user can read it. Run: chmod o-r " +
                                     path});
  EXPECT_TRUE(warnings("password = sesame\n", fs::perms::owner_all).empty());
  EXPECT_TRUE(warnings("ticks = 3\n", kOpen).empty());
  EXPECT_TRUE(warnings("password = $argon2id$v=19$m=8,t=1,p=1$c2FsdHNhbHQ$aGFzaA\n", kOpen).empty());
  std::remove(path.c_str());
}

/// Of a game that is a program: what df-config.txt says, and an environment without the variables used here.
class ProgramOptions : public testing::Test {
 protected:
  ProgramOptions() { clear(); }
  ~ProgramOptions() override { clear(); }
  static void clear() {
    for (const char* name :
         {"NAIAD_PORT", "NAIAD_HEADLESS", "NAIAD_FRAME_TIME", "NAIAD_GAME", "NAIAD_ADDRESS", "NAIAD_PUBLIC"})
      unsetenv(name);
  }
  std::set<std::string> read() {
    return readProgramOptions([this](const std::string& key) { return config[key]; }, options,
                              [](const std::string& key) { return "df-config.txt:3: " + key; });
  }
  std::string complaint() {
    options = {};
    try {
      read();
    } catch (const OptionError& error) {
      return error.what();
    }
    return {};
  }

  std::map<std::string, std::string> config;
  HostOptions options;
};

TEST_F(ProgramOptions, ComeFromTheConfigFile) {
  config = {
      {"port", "1234"}, {"max_players", "3"}, {"server_name", "den"}, {"headless", "true"}, {"grace", "1.5"}};
  const std::set<std::string> expected{"port", "max-players", "server-name", "headless", "grace"};
  EXPECT_EQ(read(), expected);
  EXPECT_EQ(options.port, 1234);
  EXPECT_EQ(options.max_players, 3);
  EXPECT_EQ(options.name, "den");
  EXPECT_TRUE(options.headless);
  EXPECT_EQ(options.grace, 1.5);
}

TEST_F(ProgramOptions, AndBeforeThatFromTheEnvironment) {
  config = {{"port", "1234"}, {"headless", "true"}};
  setenv("NAIAD_PORT", "4321", 1);
  setenv("NAIAD_HEADLESS", "0", 1);
  read();
  EXPECT_EQ(options.port, 4321);
  EXPECT_FALSE(options.headless);
}

TEST_F(ProgramOptions, TheGamesFrameTimeIsNotTheHosts) {
  config = {{"frame_time", "50"}};  // milliseconds, for GM.getFrameTime()
  EXPECT_TRUE(read().empty());
  EXPECT_EQ(options.frame_micros, 0);
  setenv("NAIAD_FRAME_TIME", "5000", 1);
  read();
  EXPECT_EQ(options.frame_micros, 5000);
}

TEST_F(ProgramOptions, WhichGameIsNoQuestion) {
  setenv("NAIAD_GAME", "hello", 1);
  config = {{"game", "hello"}};
  EXPECT_TRUE(read().empty());
  EXPECT_EQ(options.game, HostOptions().game);
}

TEST_F(ProgramOptions, ListensOnLoopbackUnlessAskedOtherwise) {
  read();
  EXPECT_EQ(options.address, "127.0.0.1");
  options = {};
  config = {{"public", "true"}};
  read();
  EXPECT_EQ(options.address, "::");
  options = {};
  config = {{"address", "192.0.2.1"}, {"public", "true"}};
  read();
  EXPECT_EQ(options.address, "192.0.2.1");
  options = {};
  config.clear();
  setenv("NAIAD_PUBLIC", "1", 1);
  read();
  EXPECT_EQ(options.address, "::");
}

TEST_F(ProgramOptions, NonsenseIsNamedWithItsPlace) {
  config = {{"port", "70000"}};
  EXPECT_EQ(complaint(), "df-config.txt:3: port: Value 70000 not in range 0 to 65535");
  setenv("NAIAD_PORT", "70001", 1);
  EXPECT_EQ(complaint(), "NAIAD_PORT: Value 70001 not in range 0 to 65535");
  unsetenv("NAIAD_PORT");
  config = {{"on_game_over", "dance"}};
  EXPECT_EQ(complaint().rfind("df-config.txt:3: on_game_over: dance not in ", 0), 0u) << complaint();
  config = {{"local_client", "perhaps"}};
  EXPECT_EQ(complaint().rfind("df-config.txt:3: local_client: ", 0), 0u) << complaint();
  config = {{"key", "key.pem"}};
  EXPECT_NE(complaint().find("--certificate"), std::string::npos) << complaint();
  config.clear();
  EXPECT_EQ(complaint(), "");
}

TEST(HostOptions, OnlyDfserverHasAControlSocketByItself) {
  HostOptions server;
  EXPECT_EQ(parse({}, server), CommandLine::kRun);
  EXPECT_TRUE(server.control_by_port);
  HostOptions off;
  EXPECT_EQ(parse({"--control", "off"}, off), CommandLine::kRun);
  EXPECT_FALSE(off.control_by_port);
  EXPECT_EQ(off.control, "");
  HostOptions named;
  EXPECT_EQ(parse({"--control", "/run/naiad/a.sock"}, named), CommandLine::kRun);
  EXPECT_FALSE(named.control_by_port);
  EXPECT_EQ(named.control, "/run/naiad/a.sock");
  HostOptions program;
  readProgramOptions([](const std::string&) { return std::string(); }, program);
  EXPECT_FALSE(program.control_by_port);
  EXPECT_EQ(program.control, "");
  EXPECT_EQ(program.state, "");
}

TEST(HostOptions, OneIsChangedByItsNameWithinItsRange) {
  HostOptions options;
  setHostOption(options, "max-players", "7");
  EXPECT_EQ(options.max_players, 7);
  EXPECT_EQ(hostOptionValue(options, "max-players"), "7");
  EXPECT_THROW(setHostOption(options, "max-players", "0"), OptionError);
  EXPECT_THROW(setHostOption(options, "max-players", "many"), OptionError);
  EXPECT_THROW(setHostOption(options, "banana", "7"), OptionError);
  EXPECT_EQ(options.max_players, 7);
}

}  // namespace
}  // namespace naiad
