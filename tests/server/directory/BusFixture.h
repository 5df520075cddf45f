// A test fixture that runs the real nats-server in a temporary folder.
#pragma once

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "host/fleet/Bus.h"
#include "tests/server/host/fleet/NatsServer.h"
#include "tests/support/TempFolder.h"
#include "tests/support/Text.h"
#include "tests/support/WaitUntil.h"

namespace naiad::test {

/// The --bus-interval of servers and directories in ms; short, so that changes are noticed soon.
inline constexpr const char* kQuickInterval = "100";

class BusFixture : public testing::Test {
 protected:
  void SetUp() override {
    if (!validateBusSettings({"nats://127.0.0.1:1", "", ""}).empty()) GTEST_SKIP() << "built without libnats";
    if (!NatsServer::isInstalled()) GTEST_SKIP() << "nats-server is not installed";
  }
  /// Returns the environment of a dfserver on this bus. Its name is its id.
  static std::map<std::string, std::string> serverOf(const NatsServer& bus, const std::string& id,
                                                     const std::string& game = "hello") {
    return {{"NAIAD_GAME", game},      {"NAIAD_BUS", bus.url()},
            {"NAIAD_BUS_ID", id},      {"NAIAD_BUS_INTERVAL", kQuickInterval},
            {"NAIAD_SERVER_NAME", id}, {"NAIAD_PUBLIC_HOST", "127.0.0.1"}};
  }

  TempFolder folder;
};

}  // namespace naiad::test
