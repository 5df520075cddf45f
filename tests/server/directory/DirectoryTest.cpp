// The program dfdir with the real nats-server and real dfservers.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "BusFixture.h"
#include "SamplePresence.h"
#include "client/lan/DiscoveredServers.h"
#include "tests/loopback/GameProgram.h"
#include "tests/support/RunningProgram.h"

namespace naiad::test {
namespace {

class DirectoryTest : public BusFixture {
 protected:
  std::string listText() const { return contentOf(folder / "servers.json"); }
  std::vector<DiscoveredServer> listed() const {
    const auto read = readServerList(listText());
    return read ? read->sorted() : std::vector<DiscoveredServer>();
  }
  std::unique_ptr<RunningProgram> startDirectory(const NatsServer& bus) const {
    return std::make_unique<RunningProgram>(std::vector<std::string>{
        "dfdir", "--bus", bus.url(), "--bus-interval", kQuickInterval, "--list", folder / "servers.json"});
  }
};

TEST_F(DirectoryTest, ServersAreListedWhileTheyAreThere) {
  NatsServer bus;
  ASSERT_TRUE(bus.start()) << bus.log();
  const auto directory = startDirectory(bus);
  GameProgram berlin("dfserver", serverOf(bus, "berlin"));
  auto paris = std::make_unique<GameProgram>("dfserver", serverOf(bus, "paris"));
  ASSERT_NE(berlin.port(), 0) << berlin.log();
  ASSERT_TRUE(waitUntil([&] { return listed().size() == 2; })) << listText() << directory->printed();
  const DiscoveredServer first = listed().front();
  EXPECT_EQ(first.name, "berlin");
  EXPECT_EQ(first.game, "hello");
  EXPECT_EQ(first.address.host, "127.0.0.1");
  EXPECT_EQ(first.address.port, berlin.port());
  EXPECT_NE(berlin.log().find(first.key.text()), std::string::npos) << "the link that dfserver prints";
  paris->signal(SIGKILL);
  paris.reset();
  EXPECT_TRUE(waitUntil([&] { return listed().size() == 1; })) << listText();
  EXPECT_EQ(listed().front().name, "berlin");
  berlin.signal(SIGTERM);
  berlin.wait();
  EXPECT_TRUE(waitUntil([&] { return listed().empty(); })) << "it has said that it lets no players in";
  directory->signal(SIGTERM);
  EXPECT_EQ(directory->finish(), 0) << directory->printed();
  EXPECT_FALSE(std::filesystem::exists(folder / "servers.json")) << "a list that is not kept up";
  EXPECT_NE(directory->printed().find("counters: heartbeats="), std::string::npos) << directory->printed();
}

TEST_F(DirectoryTest, HostilePayloadsAreCountedAndIgnored) {
  NatsServer bus("max_payload: 100KB");
  ASSERT_TRUE(bus.start()) << bus.log();
  const auto directory = startDirectory(bus);
  ASSERT_TRUE(directory->prints("the bus is connected"));
  const auto liar = connectBus({bus.url(), "", ""});
  const Presence presence = presenceOf("honest");
  liar->publish({presenceSubject("x1"), std::string(50'000, '[')});
  liar->publish({presenceSubject("x2"), "{\"v\":1}"});
  liar->publish({presenceSubject("x3"), presence.payload()});
  liar->publish({presenceSubject("honest"), presence.payload()});
  EXPECT_TRUE(waitUntil([&] { return listed().size() == 1; })) << listText();
  directory->signal(SIGTERM);
  EXPECT_EQ(directory->finish(), 0);
  for (const char* count :
       {" heartbeats=1", " unreadable=1", " wrong_subject=1", " bus_received=4", " bus_ignored=1"})
    EXPECT_NE(directory->printed().find(count), std::string::npos) << count << directory->printed();
}

TEST_F(DirectoryTest, InvalidOptionsPrintAMessageAndSetExitCode) {
  const auto expectRefusal = [](std::vector<std::string> words, int code, const std::string& text) {
    words.insert(words.begin(), "dfdir");
    RunningProgram program(words);
    EXPECT_EQ(program.finish(), code) << text;
    EXPECT_NE(program.printed().find(text), std::string::npos) << program.printed();
  };
  expectRefusal({"--help"}, 0, "--list");
  expectRefusal({}, 2, "--bus is required");
  expectRefusal({"--bus", "nats://127.0.0.1:1"}, 2, "specify --list FILE, --listen ADDRESS:PORT");
  expectRefusal({"--bus", "http://127.0.0.1", "--list", folder / "list"}, 2, "nats://HOST:PORT");
  expectRefusal({"--bsu", "x"}, 2, "--bus");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--bus-interval", "49"}, 2, "50");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--bus-interval", "60001"}, 2, "60000");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--listen", "localhost:1"}, 2, "ADDRESS:PORT");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--listen", "192.0.2.1:0", "--identity", folder / "key"}, 4,
                "192.0.2.1");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--list", folder / "none" / "list"}, 5, "cannot be written");
  expectRefusal({"--bus", "nats://127.0.0.1:1", "--list", folder.string()}, 5, "cannot be written");
}

}  // namespace
}  // namespace naiad::test
