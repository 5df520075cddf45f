// Messages about command lines, environments and files that a program does not understand.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "shared/options/Options.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class OptionsTest : public testing::Test {
 protected:
  OptionsTest() { clearVariables(); }
  ~OptionsTest() override { clearVariables(); }
  static void clearVariables() {
    for (const char* name : {"OPTIONS_TEST_PORT", "NAIAD_RECONNECT_TIME", "NAIAD_GRACE"}) unsetenv(name);
  }

  /// Parses these words and returns the output on stderr.
  std::string parse(std::vector<std::string> words) {
    std::vector<const char*> argv{"dfthing"};
    for (const std::string& word : words) argv.push_back(word.c_str());
    const std::vector<Option> options{
        {.name = "--port",
         .target = &port,
         .help = "",
         .environment = "OPTIONS_TEST_PORT",
         .range = OptionRange{0, 65535},
         .p_from_environment = &from_environment},
        {.name = "--max-players", .target = &players, .help = ""},
        {.name = "--thing", .target = &things, .help = "", .joins = true},
        {.name = "--server-name", .target = &name, .help = "", .p_location = &place},
        {.name = "--quiet", .target = &quiet, .help = "", .p_given = &given},
        {.name = "--reconnect-time",
         .target = &reconnect_time,
         .help = "",
         .environment = "NAIAD_RECONNECT_TIME"},
        {.name = "--secret", .target = &secret, .help = "", .hidden = true}};
    testing::internal::CaptureStderr();
    result = parseOptions({"dfthing", "", "", true}, options, static_cast<int>(argv.size()), argv.data());
    return testing::internal::GetCapturedStderr();
  }
  std::string parseFile(const std::string& text, std::vector<std::string> words = {}) {
    std::ofstream(config) << text;
    words.insert(words.end(), {"--config", config.string()});
    return parse(words);
  }
  /// Returns the expected error about a line of the file.
  std::string ofLine(int number, const std::string& text) const {
    return said(config.string() + ":" + std::to_string(number) + ": " + text);
  }
  /// Returns the expected error of the program, with the hint where to find help.
  static std::string said(const std::string& text) {
    return "dfthing: " + text + "\nRun dfthing --help for more information.\n";
  }

  test::TempFolder base;
  const std::filesystem::path config = base / "naiad.conf";
  ParseResult result = ParseResult::kDone;
  int port = 1;
  int players = 2;
  std::string name;
  std::string place;
  std::string things;
  int reconnect_time = 60;
  bool quiet = false;
  bool given = false;
  bool secret = false;
  bool from_environment = false;
};

TEST_F(OptionsTest, FormerNamesWorkWithANote) {
  const std::string note =
      "dfthing: --grace is now --reconnect-time; the old name will be removed in the next version\n";
  EXPECT_EQ(parse({"--grace", "5"}), note);
  EXPECT_EQ(reconnect_time, 5);
  EXPECT_EQ(parse({"--grace=6"}), note);
  EXPECT_EQ(reconnect_time, 6);
  EXPECT_EQ(parseFile("grace = 7\n"), note);
  EXPECT_EQ(reconnect_time, 7);
  setenv("NAIAD_GRACE", "8", 1);
  EXPECT_EQ(parse({}), "");
  EXPECT_EQ(reconnect_time, 8);
  setenv("NAIAD_RECONNECT_TIME", "9", 1);
  parse({});
  EXPECT_EQ(reconnect_time, 9) << "the present variable counts more";
  EXPECT_EQ(parse({"--link-host", "x"}), said("there is no option --link-host")) << "not of this program";
  EXPECT_NE(parse({"--grace", "x"}).find("--reconnect-time"), std::string::npos);
}

TEST_F(OptionsTest, EnvironmentVariableCanSupplyAnArgument) {
  const std::vector<Option> options{
      {.name = "server", .target = &name, .help = "", .environment = "OPTIONS_TEST_PORT"}};
  const std::vector<const char*> alone{"dfthing"};
  const std::vector<const char*> named{"dfthing", "here"};
  const auto parsed = [&](const std::vector<const char*>& words) {
    testing::internal::CaptureStderr();
    result = parseOptions({"dfthing", "", ""}, options, static_cast<int>(words.size()), words.data());
    return testing::internal::GetCapturedStderr();
  };
  EXPECT_EQ(parsed(alone), said("server is required"));
  for (const std::string value : {"there:9876", "-there"}) {
    setenv("OPTIONS_TEST_PORT", value.c_str(), 1);
    EXPECT_EQ(parsed(alone), "");
    EXPECT_EQ(name, value);
    EXPECT_EQ(parsed(named), "");
    EXPECT_EQ(name, "here");
  }
}

TEST_F(OptionsTest, JoiningOptionMayBeGivenSeveralTimes) {
  EXPECT_EQ(parse({"--thing", "a=1", "--thing=b,c"}), "");
  EXPECT_EQ(things, "a=1 b,c");
  things.clear();
  EXPECT_EQ(parseFile("thing = x\nport = 7\nthing = y\n"), "");
  EXPECT_EQ(things, "x y");
  things.clear();
  EXPECT_EQ(parseFile("thing = x\n", {"--thing", "z"}), "");
  EXPECT_EQ(things, "z") << "the command line counts more than the file";
}

TEST_F(OptionsTest, UnknownOptionSuggestsTheNearestOne) {
  EXPECT_EQ(parse({"--max-player", "3"}),
            said("there is no option --max-player; did you mean --max-players?"));
  EXPECT_EQ(result, ParseResult::kUsageError);
  EXPECT_EQ(parse({"--maxplayers=3"}), said("there is no option --maxplayers; did you mean --max-players?"));
  EXPECT_EQ(parse({"--config-file=x"}), said("there is no option --config-file"));
  EXPECT_EQ(parse({"--secre"}), said("there is no option --secre")) << "hidden";
  EXPECT_EQ(parse({"what"}), said("unexpected argument \"what\""));
}

TEST_F(OptionsTest, UsageErrorExitsWith2HelpWith0) {
  EXPECT_EQ(exitCodeOf(ParseResult::kRun), std::nullopt);
  EXPECT_EQ(exitCodeOf(ParseResult::kDone), 0);
  EXPECT_EQ(exitCodeOf(ParseResult::kUsageError), 2);
}

TEST_F(OptionsTest, OutOfRangeValueErrorNamesItsOption) {
  EXPECT_EQ(parse({"--port", "70000"}), said("--port: Value 70000 not in range 0 to 65535"));
  setenv("OPTIONS_TEST_PORT", "70000", 1);
  EXPECT_EQ(parse({}), said("OPTIONS_TEST_PORT: Value 70000 not in range 0 to 65535"));
  EXPECT_EQ(result, ParseResult::kUsageError);
}

TEST_F(OptionsTest, ConfigFileIsReadLineByLine) {
  EXPECT_EQ(parseFile("# a comment\n\n; another\r\n port= 70 # seventy\nmax-players =\"3\"\n"
                      "server-name = 'a \"b\" # c' # d\r\nquiet\n"),
            "");
  EXPECT_EQ(result, ParseResult::kRun);
  EXPECT_EQ(port, 70);
  EXPECT_EQ(players, 3);
  EXPECT_EQ(name, "a \"b\" # c");
  EXPECT_EQ(place, config.string() + ":6");
  EXPECT_TRUE(quiet && given);
  EXPECT_EQ(parseFile("server-name = pass#word\nquiet = false\n"), "");
  EXPECT_EQ(name, "pass#word");
  EXPECT_FALSE(quiet);
}

TEST_F(OptionsTest, EveryWrongConfigLineIsReported) {
  const std::string file = config.string();
  EXPECT_EQ(parseFile("prot = 1\nmax-players = 3\nport = 70000\n\nquite\n"),
            said(file + ":1: there is no option \"prot\"; did you mean port?\ndfthing: " + file +
                 ":3: port: Value 70000 not in range 0 to 65535\ndfthing: " + file +
                 ":5: there is no option \"quite\"; did you mean quiet?"));
  EXPECT_EQ(result, ParseResult::kUsageError);
}

TEST_F(OptionsTest, TextSettingWithoutValueIsEmpty) {
  name = "before";
  EXPECT_EQ(parseFile("server-name =\n"), "");
  EXPECT_EQ(name, "");
  EXPECT_NE(parseFile("port =\n"), "") << "a number is not";
}

TEST_F(OptionsTest, OptionPageIsPrintedInsteadOfRunning) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(parse({"--option-page", "bash"}), "");
  EXPECT_EQ(result, ParseResult::kDone);
  EXPECT_NE(testing::internal::GetCapturedStdout().find("complete -F _dfthing dfthing"), std::string::npos);
  EXPECT_EQ(parse({"--option-page", "pdf"}), said("there is no page \"pdf\""));
}

TEST_F(OptionsTest, CommandLineAndEnvironmentOverrideTheFile) {
  setenv("OPTIONS_TEST_PORT", "71", 1);
  EXPECT_EQ(parseFile("port = 70\nmax-players = 3\nserver-name = x\n", {"--max-players", "4"}), "");
  EXPECT_EQ(port, 71);
  EXPECT_EQ(players, 4);
  EXPECT_EQ(name, "x");
}

TEST_F(OptionsTest, EnvironmentOriginOfAValueIsReported) {
  EXPECT_EQ(parseFile("port = 70\n"), "");
  EXPECT_FALSE(from_environment);
  setenv("OPTIONS_TEST_PORT", "71", 1);
  EXPECT_EQ(parse({}), "");
  EXPECT_TRUE(from_environment);
  EXPECT_EQ(parse({"--port=72"}), "");
  EXPECT_FALSE(from_environment);
}

TEST_F(OptionsTest, ConfigErrorNamesFileAndLine) {
  EXPECT_EQ(parseFile("[section]\n"), ofLine(1, "there is no option \"[section]\""));
  EXPECT_EQ(parseFile("port\n"), ofLine(1, "expected \"port = …\""));
  EXPECT_EQ(parseFile("server-name = \"x\n"), ofLine(1, "missing closing quote, or text after it"));
}

TEST_F(OptionsTest, ConfigPipeIsRefusedWithoutBlocking) {
  ASSERT_EQ(mkfifo(config.c_str(), 0600), 0);
  EXPECT_TRUE(
      test::has(parse({"--config", config}), "--config: " + config.string() + " is not a regular file"));
  const std::string none = base / "none";
  EXPECT_EQ(parse({"--config", none}), said("--config: " + none + " cannot be read"));
}

TEST(NearestName, IsTheOneWithTheFewestChanges) {
  const std::vector<std::string> names{"--port", "--port-file", "--players", "--password"};
  EXPECT_EQ(nearestName("--prot", names), "--port") << "two swapped";
  EXPECT_EQ(nearestName("--player", names), "--players");
  EXPECT_EQ(nearestName("--pass", names), "--password") << "its beginning";
  EXPECT_EQ(nearestName("--zzzz", names), "");
  EXPECT_EQ(nearestName("-p", names), "");
  EXPECT_EQ(nearestName(std::string(100'000, 'x'), names), "");
}

TEST(UnknownVariables, AreReportedWithTheNearestName) {
  const char* const environment[] = {"PATH=/bin",   "NAIAD_PORT=1",  "NAIAD_PROT=1", "NAIAD_SOMETHING_ELSE=",
                                     "NAIAD_LOG=x", "XNAIAD_PROT=1", nullptr};
  EXPECT_EQ(unknownVariableWarnings(environment, "NAIAD_", {"NAIAD_PORT", "NAIAD_LOG"}),
            (std::vector<std::string>{"there is no variable NAIAD_PROT; did you mean NAIAD_PORT?",
                                      "there is no variable NAIAD_SOMETHING_ELSE"}));
}

}  // namespace
}  // namespace naiad
