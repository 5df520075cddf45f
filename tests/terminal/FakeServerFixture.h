// Fixture with the real dfclient and a server that sends it what the test needs.
#pragma once

#include <gtest/gtest.h>

#include "FakeServer.h"
#include "ProgramEnd.h"
#include "PtyTerminal.h"

namespace naiad::test {

class FakeServerFixture : public testing::Test {
 protected:
  PtyTerminal::Options options() const {
    PtyTerminal::Options options;
    options.command = {programPath("dfclient"), server.address(), "--insecure", "--name", "Ada"};
    return options;
  }

  FakeServer server;
};

}  // namespace naiad::test
