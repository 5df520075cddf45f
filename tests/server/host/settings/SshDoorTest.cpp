#include <gtest/gtest.h>

#include "host/settings/SshDoor.h"

namespace naiad {
namespace {

TEST(SshDoor, IsTheCommandToType) {
  EXPECT_EQ(SshDoor::parse("play@game.example")->command(), "ssh play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:22")->command(), "ssh play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:2222")->command(), "ssh -p 2222 play@game.example");
  EXPECT_EQ(SshDoor::parse("p_l-1@[::1]:9876")->command(), "ssh -p 9876 p_l-1@::1");
}

}  // namespace
}  // namespace naiad
