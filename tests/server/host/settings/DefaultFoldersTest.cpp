// The default folder in which dfserver records rounds.
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "host/settings/DefaultFolders.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

namespace fs = std::filesystem;

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
  struct stat facts {};
  ASSERT_EQ(stat((folder / "state" / "rounds").c_str(), &facts), 0);
  EXPECT_EQ(facts.st_mode & 0777, 0700u);
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
