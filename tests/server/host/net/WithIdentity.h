// A suite whose servers have a key: made once, in a directory of its own.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <chrono>
#include <filesystem>
#include <memory>
#include <string>

#include "host/auth/ServerIdentity.h"

namespace naiad {

class WithIdentity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    std::string name = testing::TempDir() + "naiad-identity-XXXXXX";
    directory = mkdtemp(name.data());
    identity = std::make_unique<ServerIdentity>(
        ServerIdentity::loadOrMake(directory, std::chrono::system_clock::now()));
  }
  static void TearDownTestSuite() {
    identity.reset();
    std::filesystem::remove_all(directory);
  }

  static inline std::filesystem::path directory;
  static inline std::unique_ptr<ServerIdentity> identity;
};

}  // namespace naiad
