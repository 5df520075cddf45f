// Options of dfserver that name something outside: --check-config and the start refuse what cannot be used.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "host/settings/DefaultFolders.h"
#include "host/settings/HostOptions.h"
#include "host/settings/HostOptionsCheck.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"

namespace naiad {
namespace {

class DeploymentTest : public testing::Test {
 protected:
  DeploymentTest() {
    std::ofstream(folder / "hello.so") << "a game";
    std::ofstream(folder / "file") << "a file";
    setenv("NAIAD_GAMES", folder.path().c_str(), 1);
  }
  ~DeploymentTest() override { unsetenv("NAIAD_GAMES"); }
  HostOptions options() const {
    HostOptions options;
    options.game = "hello";
    options.identity = (folder / "identity").string();
    return options;
  }
  int check(const HostOptions& options) {
    testing::internal::CaptureStderr();
    const int code = reportDeploymentProblems(options);
    printed = testing::internal::GetCapturedStderr();
    return code;
  }

  const test::TempFolder folder;
  std::string printed;
};

TEST_F(DeploymentTest, EveryOptionThatNamesSomethingOutsideIsChecked) {
  const std::string none = "/nonexistent/x";
  const std::string below_a_file = (folder / "file" / "x").string();
  std::map<std::string, std::vector<std::string>> bad{{"game", {"nosuchgame", none}},
                                                      {"address", {"localhost", "300.1.1.1", "1.2.3"}},
                                                      {"key", {none}},
                                                      {"certificate", {none, folder.string()}},
                                                      {"identity", {below_a_file}},
                                                      {"state", {below_a_file}},
                                                      {"journal", {below_a_file}},
                                                      {"log-file", {none, folder.string(), below_a_file}},
                                                      {"port-file", {none, folder.string()}},
                                                      {"join-file", {none, folder.string()}},
                                                      {"status-file", {none, folder.string()}},
                                                      {"truth-file", {none, folder.string()}},
                                                      {"proxy-socket", {none, below_a_file}},
                                                      {"control", {below_a_file}},
                                                      {"bus-credentials", {none}},
                                                      {"bus-ca", {none}},
                                                      {"password", {"$argon2id$broken"}},
                                                      {"admin-password", {"$argon2id$broken"}}};
  ASSERT_EQ(check(options()), 0) << printed;
  for (const auto& [name, values] : bad) {
    for (const std::string& value : values) {
      HostOptions changed = options();
      setHostOption(changed, name, value);
      if (name == "key") changed.certificate = (folder / "file").string();
      if (name == "certificate") changed.key = (folder / "file").string();
      const int expected = name == "game"                                                     ? 3
                           : name == "address" || name == "proxy-socket" || name == "control" ? 4
                                                                                              : 5;
      EXPECT_EQ(check(changed), expected) << name << " = " << value << ": " << printed;
      EXPECT_TRUE(printed.starts_with("dfserver: ")) << printed;
    }
  }
  // Options without an existing thing behind them, and those checked when they are parsed.
  std::istringstream others(
      "room public-host ssh-door web-address metrics max-per-address world-environment bus sandbox recover "
      "in-process tick-timeout world-memory max-players metrics-hosts metrics-public on-game-over lan "
      "bus-interval qr vote-kick room-sleep bus-id platform log-format");
  for (std::string name; others >> name;) bad[name];
  const std::regex row(R"(\| `--([a-z-]+)` \| `\w+` \| [^|]* \| (.*) \|)");
  const std::regex outside(
      "[Ff]ile|[Ff]older|[Dd]irectory|[Ss]ocket|[Pp]ath|[Aa]ddress|Game to|key \\(PEM|Certificate|hash");
  const std::string page = hostOptionsMarkdown();
  for (std::sregex_iterator found(page.begin(), page.end(), row); found != std::sregex_iterator(); ++found) {
    const std::string help = (*found)[2];
    const bool is_outside = std::regex_search(help, outside);
    EXPECT_TRUE(!is_outside || bad.contains((*found)[1])) << (*found)[1] << ": " << help;
  }
}

TEST_F(DeploymentTest, AllProblemsAreReportedAtOnce) {
  HostOptions wrong = options();
  wrong.game = "nosuchgame";
  wrong.log_file = "/nonexistent/log";
  wrong.port_file = "/nonexistent/port";
  EXPECT_EQ(check(wrong), 3);
  EXPECT_TRUE(test::has(printed, "There is no game \"nosuchgame\". Available games: "));
  EXPECT_TRUE(test::has(printed, "--log-file cannot be used: "));
  EXPECT_TRUE(test::has(printed, "--port-file cannot be used: "));
}

TEST_F(DeploymentTest, CheckCreatesNothing) {
  HostOptions all = options();
  all.game = (folder / "hello.so").string();
  for (const char* name : {"state", "journal", "log-file", "port-file", "join-file", "status-file",
                           "truth-file", "proxy-socket"})
    setHostOption(all, name, (folder / name).string());
  all.control = (folder / "sockets" / "control").string();
  EXPECT_EQ(check(all), 0) << printed;
  EXPECT_EQ(printed, "");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2) << "hello.so and file";
}

class DefaultFoldersTest : public testing::Test {
 protected:
  HostOptions parse(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), {"dfserver", "--state", (folder / "state").string()});
    std::vector<const char*> words;
    for (const std::string& argument : arguments) words.push_back(argument.c_str());
    HostOptions options;
    EXPECT_EQ(parseHostOptions(static_cast<int>(words.size()), words.data(), options), CommandLine::kRun);
    return options;
  }
  bool journals(const std::vector<std::string>& arguments) const { return usesJournal(parse(arguments)); }
  LogLine log() {
    return [this](const LogEvent& event) { lines.push_back(event.text); };
  }

  const test::TempFolder folder;
  std::vector<std::string> lines;
};

TEST_F(DefaultFoldersTest, RoundsAreRecordedUnlessAnOptionPreventsIt) {
  EXPECT_EQ(parse({}).journal, (folder / "state" / "rounds").string());
  EXPECT_TRUE(journals({"--on-game-over", "restart"}));
  EXPECT_TRUE(journals({"--room", "a=hello", "--room", "b=hello"}));
  EXPECT_EQ(parse({"--journal", "elsewhere"}).journal, "elsewhere");
  EXPECT_FALSE(parse({"--journal", "elsewhere"}).default_journal);
  EXPECT_FALSE(journals({"--journal", "off"}));
  EXPECT_FALSE(journals({"--in-process"}));
  EXPECT_FALSE(journals({"--input-mode", "private"})) << "such rounds are not gone on with";
  EXPECT_TRUE(journals({"--input-mode", "private", "--journal", "elsewhere"}));
}

TEST_F(DefaultFoldersTest, GameProgramsRecordNoRoundsByDefault) {
  HostOptions options;
  readProgramOptions([](const std::string&) { return std::string(); }, options);
  EXPECT_FALSE(usesJournal(options));
  readProgramOptions([](const std::string& key) { return key == "journal" ? "off" : ""; }, options);
  EXPECT_FALSE(usesJournal(options));
  EXPECT_EQ(options.journal, "");
}

TEST_F(DefaultFoldersTest, TheFolderIsMadeForThisUserAlone) {
  EXPECT_TRUE(usesJournal(withUsableJournal(parse({}), log())));
  EXPECT_TRUE(lines.empty());
  EXPECT_EQ(test::modeOf(folder / "state" / "rounds"), 0700u);
}

TEST_F(DefaultFoldersTest, UncreatableFolderIsLoggedAndDisablesTheJournal) {
  std::ofstream(folder / "state") << "a file";
  EXPECT_FALSE(usesJournal(withUsableJournal(parse({}), log())));
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("not recording rounds"), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find((folder / "state" / "rounds").string()), std::string::npos) << lines[0];
  EXPECT_NE(lines[0].find("Not a directory"), std::string::npos) << lines[0];
  lines.clear();
  EXPECT_TRUE(usesJournal(withUsableJournal(parse({"--journal", (folder / "state").string()}), log())))
      << "what was asked for fails where it is used";
  EXPECT_TRUE(lines.empty());
}

}  // namespace
}  // namespace naiad
