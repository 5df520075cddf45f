// Finds files by names in wrong case, as on systems that ignore case.

#include <filesystem>
#include <fstream>

#include "engine/managers/ResourceManager.h"
#include "engine/world/Resources.h"
#include "tests/server/engine/Probe.h"
#include "tests/support/TempFolder.h"

namespace df::test {
namespace {

namespace fs = std::filesystem;

class CaseInsensitiveFile : public WorldTest {
 protected:
  CaseInsensitiveFile() {
    fs::create_directories(folder / "sprites" / "Walls");
    write("sprites/Walls/Brick.txt");
    write("sprites/ship.txt");
    write("sprites/SHIP.txt");
  }

  void write(const std::string& name) const {
    std::ofstream(folder / name)
        << "<HEADER>\nframes 1\nwidth 1\nheight 1\n</HEADER>\n<BODY>\n*\nend\n</BODY>\n";
  }

  naiad::test::TempFolder folder;
};

TEST_F(CaseInsensitiveFile, BackslashesSeparateFoldersAndCaseIsIgnored) {
  const std::string brick = (folder / "sprites" / "Walls" / "Brick.txt").string();
  for (const char* name : {"sprites\\Walls\\Brick.txt", "Sprites/walls/brick.TXT",
                           "./SPRITES\\.\\walls/BRICK.txt", "sprites/../sprites/walls/brick.txt"}) {
    std::error_code error;
    EXPECT_TRUE(fs::equivalent(findCaseInsensitive(folder.string(), name), brick, error)) << name;
  }
}

TEST_F(CaseInsensitiveFile, MissingFilesAndFoldersAreNotFound) {
  EXPECT_EQ(findCaseInsensitive(folder.string(), "sprites/none.txt"), "");
  EXPECT_EQ(findCaseInsensitive(folder.string(), "sprites\\walls"), "");
  EXPECT_EQ(findCaseInsensitive((folder / "nowhere").string(), "ship.txt"), "");
  EXPECT_EQ(findCaseInsensitive(folder.string(), ""), "");
}

TEST_F(CaseInsensitiveFile, SeveralMatchesReturnTheFirstByName) {
  EXPECT_EQ(findCaseInsensitive(folder.string(), "sprites/Ship.txt"),
            (folder / "sprites" / "SHIP.txt").string());
}

TEST_F(CaseInsensitiveFile, SpriteFilesAreFoundInAnyCase) {
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  EXPECT_EQ(RM.loadSprite("Sprites\\walls\\brick.txt", "brick"), 0);
  EXPECT_EQ(RM.loadSprite("Sprites\\walls\\none.txt", "none"), -1);
  fs::current_path(before);
  EXPECT_NE(RM.getSprite("brick"), nullptr);
  EXPECT_EQ(logged("Sprites\\walls\\none.txt: cannot be read"), 1);
}

}  // namespace
}  // namespace df::test
