#include <gtest/gtest.h>

#include <string>

#include "host/settings/SshDoor.h"

namespace naiad {
namespace {

const std::string kSsh = "ssh -o IgnoreUnknown=ObscureKeystrokeTiming -o ObscureKeystrokeTiming=no ";

TEST(SshDoor, ReturnsTheSshCommand) {
  EXPECT_EQ(SshDoor::parse("play@game.example")->command(), kSsh + "play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:22")->command(), kSsh + "play@game.example");
  EXPECT_EQ(SshDoor::parse("play@game.example:2222")->command(), kSsh + "-p 2222 play@game.example");
  EXPECT_EQ(SshDoor::parse("p_l-1@[::1]:9876")->command(), kSsh + "-p 9876 p_l-1@::1");
}

}  // namespace
}  // namespace naiad
