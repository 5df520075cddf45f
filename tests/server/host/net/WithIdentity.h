// A test suite whose servers have a key, created once in a temporary directory.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>

#include "host/auth/ServerIdentity.h"
#include "tests/support/TempFolder.h"

namespace naiad {

class WithIdentity : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    identity = std::make_unique<ServerIdentity>(
        ServerIdentity::loadOrMake(test::TempFolder(), std::chrono::system_clock::now()));
  }
  static void TearDownTestSuite() { identity.reset(); }

  static inline std::unique_ptr<ServerIdentity> identity;
};

}  // namespace naiad
