// A test fixture that runs the real nats-server in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include "host/fleet/Bus.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

namespace naiad::test {

class BusFixture : public testing::Test {
 protected:
  void SetUp() override {
    if (!validateBusSettings({"nats://127.0.0.1:1", "", ""}).empty()) GTEST_SKIP() << "built without libnats";
    if (!NatsServer::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
  }

  TempFolder folder;
};

}  // namespace naiad::test
