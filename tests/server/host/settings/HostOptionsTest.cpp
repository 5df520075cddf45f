// The command line of dfserver: mistakes are errors instead of starting a wrong server.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "host/settings/HostOptions.h"
#include "host/settings/MetricsAddress.h"
#include "host/settings/RoomOptions.h"
#include "host/settings/SshDoor.h"
#include "shared/options/Options.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

CommandLine parse(const std::vector<const char*>& arguments, HostOptions& options) {
  std::vector<const char*> all = {"dfserver"};
  all.insert(all.end(), arguments.begin(), arguments.end());
  return parseHostOptions(static_cast<int>(all.size()), all.data(), options);
}

// A duration's help names the unit of a number without one.
TEST(HostOptions, EveryDurationIsReadWithAndWithoutUnit) {
  const std::regex row(R"(\| `--([a-z-]+)` \| `\w+` \| ([0-9.]+) \| (.*) \|)");
  const std::string page = hostOptionsMarkdown();
  int durations = 0;
  for (std::sregex_iterator found(page.begin(), page.end(), row); found != std::sregex_iterator(); ++found) {
    const std::string name = (*found)[1];
    const std::string help = (*found)[3];
    const char* const p_number = test::has(help, "microseconds")   ? "1000000"
                                 : test::has(help, "milliseconds") ? "1000"
                                 : test::has(help, "econds")       ? "1"
                                                                   : nullptr;
    if (p_number == nullptr) continue;
    ++durations;
    for (const char* text : {p_number, "1s", "1000ms"}) {
      HostOptions options;
      EXPECT_NO_THROW(setHostOption(options, name, text)) << name << ' ' << text;
      EXPECT_EQ(hostOptionValue(options, name), p_number) << name << ' ' << text;
    }
    HostOptions options;
    EXPECT_THROW(setHostOption(options, name, "1x"), OptionError) << name;
    EXPECT_THROW(setHostOption(options, name, "1000d"), OptionError) << name << " has a range";
  }
  EXPECT_EQ(durations, 8);
}

TEST(HostOptions, RereadingThrowsInsteadOfPrinting) {
  const char* const good[] = {"dfserver", "--max-players", "3"};
  EXPECT_EQ(readHostOptions(3, good).max_players, 3);
  const char* const bad[] = {"dfserver", "--max-players", "many"};
  EXPECT_THROW(readHostOptions(3, bad), OptionError);
  const char* const together[] = {"dfserver", "--qr"};
  EXPECT_THROW(readHostOptions(2, together), OptionError);
  const char* const unknown[] = {"dfserver", "--max-plyers", "3"};
  EXPECT_EQ(test::errorOf<OptionError>([&] { readHostOptions(3, unknown); }),
            "there is no option --max-plyers; did you mean --max-players?");
}

TEST(HostOptions, ReloadAppliesChangeableOptions) {
  HostOptions now;
  HostOptions next;
  EXPECT_EQ(applyReloadable(next, now).text(), "no changes");
  next.max_players = 7;
  next.password = "xyzzy";
  next.grace = 12.5;
  next.log_chat = true;
  EXPECT_EQ(applyReloadable(next, now).text(),
            "max-players, password, reconnect-time and log-chat have changed");
  EXPECT_EQ(now.max_players, 7);
  EXPECT_EQ(now.password, "xyzzy");
  EXPECT_EQ(now.grace, 12.5);
  EXPECT_TRUE(now.log_chat);
}

TEST(HostOptions, ReloadNamesOptionsThatNeedARestart) {
  HostOptions now;
  HostOptions next;
  next.port = 1;
  next.max_players = 7;
  EXPECT_EQ(applyReloadable(next, now).text(), "max-players has changed; port needs a restart");
  EXPECT_EQ(now.port, HostOptions().port);
  next.game = "tron";
  EXPECT_EQ(applyReloadable(next, now).text(), "no changes; game and port need a restart");
}

/// While this exists, the games hello and tron are found, but cannot be loaded.
class Games {
 public:
  Games() {
    for (const char* game : {"hello.so", "tron.so"}) std::ofstream(m_folder / game) << "no module";
    setenv("NAIAD_GAMES", m_folder.path().c_str(), 1);
  }
  ~Games() { unsetenv("NAIAD_GAMES"); }

 private:
  const test::TempFolder m_folder;
};

std::string complaintOf(const std::vector<const char*>& rooms) {
  std::vector<const char*> words;
  for (const char* p_room : rooms) words.insert(words.end(), {"--room", p_room});
  HostOptions options;
  testing::internal::CaptureStderr();
  const CommandLine line = parse(words, options);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_EQ(line, CommandLine::kUsageError) << said;
  return said.substr(0, said.find('\n'));
}

TEST(HostOptions, RoomsAreReadInTheirOrder) {
  const Games games;
  HostOptions options;
  ASSERT_EQ(
      parse({"--room", "first=hello", "--room", "Second_2=tron,max-players=3,players=first,world-memory=512",
             "--max-players", "40", "--room-sleep", "2.5"},
            options),
      CommandLine::kRun);
  const std::vector<RoomOptions> rooms = parseRooms(options);
  ASSERT_EQ(rooms.size(), 2u);
  EXPECT_EQ(rooms[0].name, "first");
  EXPECT_EQ(rooms[0].game, "hello");
  EXPECT_EQ(rooms[0].max_players, 40);
  EXPECT_EQ(rooms[0].players, "together");
  EXPECT_EQ(rooms[1].name, "Second_2");
  EXPECT_EQ(rooms[1].max_players, 3);
  EXPECT_EQ(rooms[1].world_memory, 512);
  EXPECT_EQ(rooms[1].players, "first");
  EXPECT_EQ(options.game, "hello") << "where players begin";
  EXPECT_EQ(options.room_sleep, 2.5);
  EXPECT_TRUE(parseRooms(HostOptions()).empty());
}

TEST(HostOptions, InvalidRoomIsRejectedWithTheNearestMatch) {
  const Games games;
  EXPECT_EQ(complaintOf({"hello"}), "dfserver: --room \"hello\": expected NAME=GAME or NAME=GAME,KEY=VALUE");
  EXPECT_EQ(complaintOf({"a b=hello"}), "dfserver: --room \"a\": expected NAME=GAME or NAME=GAME,KEY=VALUE");
  for (const char* name : {"=hello", "-x=hello", "a/b=hello", "\xc3\xbc=hello", "\033[2J=hello"}) {
    const std::string said = complaintOf({name});
    EXPECT_TRUE(test::has(said, ": 1 to 32 of"));
    EXPECT_FALSE(test::has(said, "\033"));
  }
  EXPECT_EQ(complaintOf({"a=hello", "b=tron", "A=hello"}), "dfserver: --room A: this name is used twice");
  EXPECT_EQ(complaintOf({"a=helo"}), "dfserver: --room a: unknown game \"helo\"; did you mean hello?");
  EXPECT_EQ(complaintOf({"a=zzzzzz"}),
            "dfserver: --room a: unknown game \"zzzzzz\"; --list-games prints the known ones");
  EXPECT_EQ(complaintOf({"a=/no/such/game.so"}), "dfserver: --room a: no such file: \"/no/such/game.so\"");
  EXPECT_EQ(complaintOf({"a=hello,max-player=3"}),
            "dfserver: --room a: unknown room setting \"max-player\"; did you mean max-players?");
  EXPECT_EQ(complaintOf({"a=hello,max-players"}), "dfserver: --room a: max-players: expected KEY=VALUE");
  EXPECT_TRUE(test::has(complaintOf({"a=hello,max-players=many"}), "--room a: max-players: "));
  EXPECT_TRUE(test::has(complaintOf({"a=hello,input-mode=private"}), "--room a: input-mode: "));
  std::vector<std::string> many;
  for (int i = 0; i < 65; ++i) many.push_back("room-" + std::to_string(i) + "=hello");
  std::vector<const char*> all;
  for (const std::string& room : many) all.push_back(room.c_str());
  EXPECT_EQ(complaintOf(all), "dfserver: --room: at most 64 rooms are possible, not 65");
}

TEST(HostOptions, ImpossibleValuesAndCombinationsAreErrors) {
  const Games games;
  const std::string most = std::to_string(kMaxServerPlayers);
  const std::string more = std::to_string(kMaxServerPlayers + 1);
  const std::pair<bool, std::vector<const char*>> all[] = {
      {true, {"--input-mode", "first", "--on-game-over", "exit"}},
      {false, {"--input-mode", "nobody"}},
      {false, {"--replica-audit", "perhaps"}},
      {false, {"--headless"}},  // an option of game programs
      {true, {"--frame-time", "0"}},
      {true, {"--frame-time", "1000"}},
      {false, {"--frame-time", "999"}},
      {true, {"--max-players", most.c_str(), "--max-per-address", most.c_str()}},
      {false, {"--max-per-address", more.c_str()}},
      {false, {"--max-per-address", "0"}},
      {true, {"--lan", "on"}},
      {false, {"--lan", "on", "--insecure"}},
      {true, {"--proxy-socket", "visitors"}},
      {false, {"--proxy-socket", "visitors", "--insecure"}},
      {true, {"--certificate", "c", "--key", "k"}},
      {false, {"--certificate", "c", "--key", "k", "--insecure"}},
      {false, {"--room", "a=hello", "--input-mode", "private"}},
      {false, {"--room", "a=hello", "--on-game-over", "exit"}},
      {false, {"--room", "a=hello", "--truth-file", "/tmp/t"}},
      {true, {"--truth-file", "", "--journal", "/tmp"}},
      {true, {"--public-host", "game.example:9877", "--ssh-door", "play@game.example:2222"}},
      {true, {"--web-address", "https://game.example/play", "--qr"}},
      {false, {"--qr"}},
      {false, {"--public-host", "a b"}},
      {false, {"--public-host", "http://x"}},
      {false, {"--ssh-door", "game.example"}},
      {false, {"--ssh-door", "a;b@x"}},
      {false, {"--ssh-door=-oX@y"}},
      {false, {"--ssh-door", "@x"}},
      {false, {"--web-address", "ftp://x"}},
      {false, {"--web-address", "https://x y"}}};
  for (const auto& [runs, words] : all) {
    HostOptions options;
    EXPECT_EQ(parse(words, options), runs ? CommandLine::kRun : CommandLine::kUsageError)
        << testing::PrintToString(words);
  }
}

TEST(HostOptions, UnknownRoomMessageSuggestsTheNearest) {
  EXPECT_EQ(unknownRoomMessage("tronn", {"lobby", "tron"}),
            "There is no room \"tronn\"; did you mean \"tron\"?");
  EXPECT_FALSE(test::has(unknownRoomMessage("x\033[2J", {"lobby", "tron"}), "\033"));
  EXPECT_EQ(unknownRoomMessage("", {"lobby", "tron"}), "There is no room \"\". Rooms: lobby, tron.");
}

TEST(HostOptions, PublicMetricsAddressNeedsAnExplicitOption) {
  for (const char* address : {"127.0.0.1:0", "[::1]:9100", "10.0.0.7:9100"}) {
    HostOptions options;
    EXPECT_EQ(parse({"--metrics", address, "--metrics-hosts", "game.internal,b"}, options),
              CommandLine::kRun);
    EXPECT_EQ(options.metrics, address);
  }
  for (const char* address : {"0.0.0.0:9100", "[::]:9100", "8.8.8.8:9100"}) {
    HostOptions options;
    EXPECT_EQ(parse({"--metrics", address}, options), CommandLine::kUsageError) << address;
    EXPECT_EQ(parse({"--metrics", address, "--metrics-public"}, options), CommandLine::kRun) << address;
  }
  HostOptions options;
  EXPECT_EQ(parse({"--metrics", "localhost:9100"}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--metrics", "127.0.0.1"}, options), CommandLine::kUsageError);
  EXPECT_EQ(parse({"--metrics-hosts", "a b"}, options), CommandLine::kUsageError);
}

class ConfigFileTest : public testing::Test {
 protected:
  const test::TempFolder folder;
  const std::string path = folder / "server.conf";
};

TEST_F(ConfigFileTest, PasswordReadableByAllUsersCausesAWarning) {
  namespace fs = std::filesystem;
  const auto warnings = [this](const std::string& text, fs::perms perms) {
    std::ofstream(path) << text;
    fs::permissions(path, perms);
    HostOptions options;
    EXPECT_EQ(parse({"--config", path.c_str()}, options), CommandLine::kRun);
    // The environment may hold variables of other tests.
    std::erase_if(options.warnings, [](const std::string& warning) {
      return warning.starts_with("there is no variable NAIAD_");
    });
    return options.warnings;
  };
  constexpr fs::perms kOpen = fs::perms::owner_all | fs::perms::others_read;
  EXPECT_EQ(warnings("password = sesame\n", kOpen),
            std::vector<std::string>{path + " has the password, but every user can read it. Run: chmod o-r " +
                                     path});
  EXPECT_TRUE(warnings("password = sesame\n", fs::perms::owner_all).empty());
  EXPECT_TRUE(warnings("ticks = 3\n", kOpen).empty());
  EXPECT_TRUE(warnings("password = $argon2id$v=19$m=8,t=1,p=1$c2FsdHNhbHQ$aGFzaA\n", kOpen).empty());
}

/// Options of a game program: its df-config.txt, and an environment without the variables used here.
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
    return test::errorOf<OptionError>([this] { read(); });
  }

  std::map<std::string, std::string> config;
  HostOptions options;
};

TEST_F(ProgramOptions, ComeFromTheConfigFile) {
  config = {
      {"port", "1234"}, {"max_players", "3"}, {"server_name", "den"}, {"headless", "true"}, {"grace", "1.5"}};
  const std::set<std::string> expected{"port", "max-players", "server-name", "headless", "reconnect-time"};
  EXPECT_EQ(read(), expected);
  EXPECT_EQ(options.port, 1234);
  EXPECT_EQ(options.max_players, 3);
  EXPECT_EQ(options.name, "den");
  EXPECT_TRUE(options.headless);
  EXPECT_EQ(options.grace, 1.5);
}

TEST_F(ProgramOptions, EnvironmentOverridesTheConfigFile) {
  config = {{"port", "1234"}, {"headless", "true"}};
  setenv("NAIAD_PORT", "4321", 1);
  setenv("NAIAD_HEADLESS", "0", 1);
  read();
  EXPECT_EQ(options.port, 4321);
  EXPECT_FALSE(options.headless);
}

TEST_F(ProgramOptions, TheGamesFrameTimeIsNotTheHosts) {
  config = {{"frame_time", "50"}};  // milliseconds, for GM.getFrameTime() only
  EXPECT_TRUE(read().empty());
  EXPECT_EQ(options.frame_micros, 0);
  setenv("NAIAD_FRAME_TIME", "5000", 1);
  read();
  EXPECT_EQ(options.frame_micros, 5000);
}

TEST_F(ProgramOptions, ConfiguredGameNameIsIgnored) {
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

TEST_F(ProgramOptions, InvalidValueIsReportedWithItsLocation) {
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
  EXPECT_TRUE(test::has(complaint(), "--certificate"));
  config.clear();
  EXPECT_EQ(complaint(), "");
}

TEST(HostOptions, OnlyDfserverHasAControlSocketByDefault) {
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

/// Returns the output of an option that prints a page or the configuration.
std::string printed(const std::vector<const char*>& arguments, CommandLine wanted = CommandLine::kDone) {
  HostOptions options;
  testing::internal::CaptureStdout();
  EXPECT_EQ(parse(arguments, options), wanted);
  return testing::internal::GetCapturedStdout();
}

// Checks that each line of the example is valid without its leading #, and sets the default.
TEST_F(ConfigFileTest, TheExampleOfAConfigurationHasTheDefaults) {
  std::istringstream lines(printed({"--option-page", "config"}));
  std::ofstream example(path);
  int settings = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool is_setting = line.size() > 1 && line[0] == '#' && line[1] != ' ';
    settings += is_setting ? 1 : 0;
    example << (is_setting ? line.substr(1) : line) << "\n";
  }
  example.close();
  EXPECT_GT(settings, 25);
  EXPECT_EQ(printed({"--config", path.c_str(), "--print-config"}), printed({"--print-config"}));
}

TEST_F(ConfigFileTest, PrintedConfigurationCanBeReadAgain) {
  const std::vector<const char*> given{"--server-name", "a # \"b\"",     "--port",      "0",
                                       "--qr",          "--web-address", "https://x/#y"};
  std::vector<const char*> words = given;
  words.push_back("--print-config");
  const std::string first = printed(words);
  EXPECT_TRUE(test::has(first, "\nport = 0\n"));
  std::ofstream(path) << first;
  EXPECT_EQ(printed({"--config", path.c_str(), "--print-config"}), first);
}

TEST(HostOptions, APasswordIsNotPrinted) {
  const std::string text = printed({"--password", "verysecret", "--print-config"});
  EXPECT_FALSE(test::has(text, "verysecret"));
  EXPECT_TRUE(test::has(text, "# password is set, but not printed\n"));
}

TEST_F(ConfigFileTest, AConfigurationIsCheckedWithoutAServer) {
  std::ofstream(path) << "prot = 1\n\nmax-players = many\n";
  testing::internal::CaptureStderr();
  HostOptions options;
  EXPECT_EQ(parse({"--config", path.c_str(), "--check-config"}, options), CommandLine::kUsageError);
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_TRUE(test::has(said, "dfserver: " + path + ":1: there is no option \"prot\"; did you mean port?\n"));
  EXPECT_TRUE(test::has(said, "dfserver: " + path + ":3: max-players: "));
  const Games games;
  const test::TempFolder temp;
  const std::string state = temp.string();
  std::ofstream(path) << "port = 1\ngame = hello\n";
  EXPECT_EQ(printed({"--config", path.c_str(), "--check-config", "--state", state.c_str(), "--identity",
                     state.c_str()}),
            "");
  std::ofstream(path) << "certificate = x\n";
  printed({"--config", path.c_str(), "--check-config"}, CommandLine::kUsageError);
}

TEST(HostOptions, UnknownEnvironmentVariableCausesAWarning) {
  setenv("NAIAD_MAX_PLAYER", "3", 1);
  HostOptions options;
  EXPECT_EQ(parse({}, options), CommandLine::kRun);
  unsetenv("NAIAD_MAX_PLAYER");
  EXPECT_EQ(std::ranges::count(options.warnings,
                               "there is no variable NAIAD_MAX_PLAYER; did you mean NAIAD_MAX_PLAYERS?"),
            1);
}

// Variables of the other programs are accepted, because they may be set for all programs.
TEST(HostOptions, VariablesOfOtherProgramsCauseNoWarning) {
  namespace fs = std::filesystem;
  std::set<std::string> names;
  const std::regex name("[\"`](NAIAD_[A-Z_]+)[\"`]");
  const auto add = [&](const std::string& source) {
    for (std::sregex_iterator found(source.begin(), source.end(), name); found != std::sregex_iterator();
         ++found)
      names.insert((*found)[1]);
  };
  for (const char* folder : {"client", "shared", "server"}) {
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(NAIAD_SOURCE_DIR) / folder)) {
      if (entry.path().extension() != ".cpp") continue;
      std::ostringstream text;
      text << std::ifstream(entry.path()).rdbuf();
      add(text.str());
    }
  }
  EXPECT_GT(names.size(), 20u);
  add(hostOptionsMarkdown());
  names.erase("NAIAD_");
  for (const std::string& variable : names) {
    if (getenv(variable.c_str()) != nullptr) continue;
    setenv(variable.c_str(), "", 1);
    HostOptions options;
    parse({"--check-config"}, options);
    unsetenv(variable.c_str());
    EXPECT_EQ(std::ranges::count(options.warnings, "there is no variable " + variable), 0) << variable;
  }
}

TEST(HostOptions, SocketsFromTheServiceManagerDecideAddressAndPort) {
  HostOptions options;
  useSockets({3, 4, "127.0.0.1", 4000}, options);
  EXPECT_EQ(options.address, "127.0.0.1");
  EXPECT_EQ(options.port, 4000);
  EXPECT_TRUE(options.warnings.empty()) << "nothing else was asked for";
  HostOptions other;
  other.port = 5000;
  useSockets({3, 4, "127.0.0.1", 4000}, other);
  EXPECT_EQ(other.warnings, std::vector<std::string>{
                                "using port 4000 of the sockets from the service manager instead of 5000"});
}

const std::string kSsh = "ssh -o IgnoreUnknown=ObscureKeystrokeTiming -o ObscureKeystrokeTiming=no ";

TEST(SshDoor, ReturnsTheSshCommand) {
  EXPECT_EQ(SshDoor::parse("play@game.example")->command(), kSsh + "play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:22")->command(), kSsh + "play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:2222")->command(), kSsh + "-p 2222 play@game.example");
  EXPECT_EQ(SshDoor::parse("p_l-1@[::1]:9876")->command(), kSsh + "-p 9876 p_l-1@::1");
}

TEST(MetricsAddress, IsANumericAddressAndAPort) {
  for (const auto& [text, address, port, host] :
       {std::tuple{"127.0.0.1:9100", "127.0.0.1", 9100, "127.0.0.1"}, {"[::1]:0", "::1", 0, "[::1]"}}) {
    const auto parsed = MetricsAddress::parse(text);
    ASSERT_TRUE(parsed) << text;
    EXPECT_EQ(parsed->address, address);
    EXPECT_EQ(parsed->port, port);
    EXPECT_EQ(parsed->hostText(), host);
  }
}

TEST(MetricsAddress, RejectsInvalidAddresses) {
  for (const char* text :
       {"", "9100", ":9100", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:1x",
        "::1:9100", "[::1]", "[127.0.0.1]:1", "localhost:9100", "[]:1", "127.0.0.1:9100 ", "[::1]9100"}) {
    EXPECT_FALSE(MetricsAddress::parse(text)) << text;
  }
}

TEST(MetricsAddress, TellsPrivateAddressesFromPublicOnes) {
  const auto isPrivate = [](const char* text) {
    const auto address = MetricsAddress::parse(text);
    EXPECT_TRUE(address) << text;
    return address && address->is_private;
  };
  for (const char* text :
       {"127.0.0.1:1", "127.255.0.9:1", "10.1.2.3:1", "172.16.0.1:1", "172.31.255.255:1", "192.168.7.7:1",
        "169.254.0.1:1", "[::1]:1", "[fd00::1]:1", "[fe80::1]:1", "[::ffff:10.0.0.1]:1"})
    EXPECT_TRUE(isPrivate(text)) << text;
  for (const char* text :
       {"0.0.0.0:1", "[::]:1", "8.8.8.8:1", "172.15.255.255:1", "172.32.0.1:1", "192.169.0.1:1", "11.0.0.1:1",
        "128.0.0.1:1", "[2001:db8::1]:1", "[fec0::1]:1", "[::ffff:8.8.8.8]:1"})
    EXPECT_FALSE(isPrivate(text)) << text;
}

TEST(MetricsHosts, AllowLocalhostNumericAddressesAndConfiguredNames) {
  const auto hosts = MetricsHosts::parse("game.internal,Node-7");
  ASSERT_TRUE(hosts);
  for (const char* host : {"localhost", "LOCALHOST:9100", "127.0.0.1", "127.0.0.1:1", "[::1]", "[::1]:9100",
                           "10.0.0.9:9100", "game.internal", "Game.Internal:80", "node-7"}) {
    EXPECT_TRUE(hosts->allows(host)) << host;
  }
  for (const char* host :
       {"", ":", "evil.example", "evil.example:9100", "localhost.evil.example", "localhost:x",
        "localhost:99999", "game", "127.0.0.1.evil.example", "user@localhost", "localhost "}) {
    EXPECT_FALSE(hosts->allows(host)) << host;
  }
}

TEST(MetricsHosts, RejectInvalidNames) {
  EXPECT_TRUE(MetricsHosts::parse(""));
  for (const char* names : {",", "a,,b", "a b", "a:80", "http://a", "-a", "a,-b"}) {
    EXPECT_FALSE(MetricsHosts::parse(names)) << names;
  }
}

}  // namespace
}  // namespace naiad
