// The program dfdir with the real nats-server and real dfservers. The files of deploy/fleet/make-fleet: a TLS
// bus on which each program may use only its own subjects.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "BusFixture.h"
#include "SamplePresence.h"
#include "client/lan/DiscoveredServers.h"
#include "shared/fleet/BusPayloads.h"
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
  berlin.end(SIGTERM);
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

namespace fs = std::filesystem;

/// Removes the section "jetstream" from nats-server's configuration, because NatsServer sets its own store.
std::string withoutStore(std::string conf) {
  const std::size_t begin = conf.find("jetstream {");
  return conf.erase(begin, conf.find("}\n", begin) + 2 - begin);
}

class FleetFilesTest : public BusFixture {
 protected:
  void SetUp() override {
    BusFixture::SetUp();
    if (IsSkipped()) return;
    ASSERT_EQ(make("127.0.0.1 tron=2 maze=1"), 0);
    nats = std::make_unique<NatsServer>(withoutStore(contentOf(folder / "bus" / "nats.conf")));
    ASSERT_TRUE(nats->start()) << nats->log();
  }
  int make(const std::string& words) const {
    const std::string command =
        NAIAD_SOURCE_DIR "/deploy/fleet/make-fleet " + folder.string() + " " + words + " >/dev/null 2>&1";
    return WEXITSTATUS(::system(command.c_str()));
  }
  /// Returns the bus address in a file, with the port of this test.
  std::string urlIn(const fs::path& file) const {
    const std::string text = contentOf(folder / file);
    const std::size_t begin = text.find("tls://");
    std::string url = text.substr(begin, text.find('\n', begin) - begin);
    const std::string here = nats->url();
    return url.substr(0, url.rfind(':')) + here.substr(here.rfind(':'));
  }
  std::unique_ptr<Bus> connect(const fs::path& file, std::vector<std::string> subjects = {}) const {
    return connectBus({urlIn(file), "", folder / "bus" / "ca.pem", std::move(subjects)});
  }

  const fs::path folder = BusFixture::folder / "fleet";
  std::unique_ptr<NatsServer> nats;
};

TEST_F(FleetFilesTest, SecretFilesAreReadableByTheOwnerOnly) {
  for (const fs::path& file :
       {folder / "bus" / "nats.conf", folder / "bus" / "key.pem", folder / "bus" / "reader.password",
        folder / "servers" / "tron-1.conf", folder / "directory" / "dfdir.env"}) {
    struct stat facts {};
    ASSERT_EQ(::stat(file.c_str(), &facts), 0) << file;
    EXPECT_EQ(facts.st_mode & 077, 0u) << file;
  }
  EXPECT_FALSE(fs::exists(folder / "bus" / "ca.key")) << "the key of the authority is not kept";
  EXPECT_FALSE(has(contentOf(folder / "bus" / "nats.conf"),
                   contentOf(folder / "bus" / "reader.password").substr(0, 32)))
      << "passwords are hashed";
  EXPECT_EQ(make("127.0.0.1 tron=2"), 1) << "it is there already";
}

TEST_F(FleetFilesTest, EachServerUsesOnlyItsOwnBusSubjects) {
  const auto directory = connect("directory/dfdir.env", {"naiad.presence.*"});
  const auto tron = connect("servers/tron-1.conf", {redirectSubject("tron-1"), redirectSubject("maze-1")});
  ASSERT_TRUE(waitUntil([&] { return directory->isConnected() && tron->isConnected(); }))
      << directory->popLogMessage() << nats->log();
  std::vector<BusMessage> heard;
  EXPECT_TRUE(waitUntil([&] {
    tron->publish({presenceSubject("maze-1"), "a lie"});
    tron->publish({redirectSubject("tron-2"), "a lie"});
    tron->publish({presenceSubject("tron-1"), "here"});
    for (BusMessage& one : directory->popMessages()) heard.push_back(std::move(one));
    return !heard.empty();
  }));
  for (const BusMessage& one : heard) EXPECT_EQ(one.subject, presenceSubject("tron-1"));
  heard.clear();
  EXPECT_TRUE(waitUntil([&] {
    directory->publish({presenceSubject("tron-2"), "a lie"});
    directory->publish({redirectSubject("maze-1"), "for another"});
    directory->publish({redirectSubject("tron-1"), "for it"});
    for (BusMessage& one : tron->popMessages()) heard.push_back(std::move(one));
    return !heard.empty();
  }));
  for (const BusMessage& one : heard) EXPECT_EQ(one.subject, redirectSubject("tron-1"));
  for (const char* said : {"Publish Violation", "Subscription Violation"})
    EXPECT_TRUE(waitUntil([&] { return nats->log().find(said) != std::string::npos; }))
        << said << nats->log();
}

TEST_F(FleetFilesTest, BusConnectionFailsWithoutPasswordTrustedAuthorityOrTls) {
  const std::string url = urlIn("servers/tron-1.conf");
  const std::string without = "tls://" + url.substr(url.find('@') + 1);
  const auto stranger = connectBus({without, "", folder / "bus" / "ca.pem"});
  const auto trusting = connectBus({url, "", ""});  // trusts only the system's certificate authorities
  const auto plain = connectBus({"nats" + url.substr(3), "", ""});
  for (const auto* const p_bus : {&stranger, &trusting, &plain}) {
    EXPECT_TRUE(waitUntil([&] { return (*p_bus)->counters().failures > 0; }));
    EXPECT_FALSE((*p_bus)->isConnected());
  }
}

TEST_F(FleetFilesTest, DirectoryListsAServerStartedWithItsGeneratedConfig) {
  GameProgram server("dfserver", {{"NAIAD_BUS", urlIn("servers/maze-1.conf")}, {"NAIAD_GAME", "maze"}},
                     {"--config", folder / "servers" / "maze-1.conf"});
  ASSERT_NE(server.port(), 0) << server.log();
  RunningProgram directory({"dfdir", "--bus", urlIn("directory/dfdir.env"), "--bus-ca",
                            folder / "bus" / "ca.pem", "--bus-interval", kQuickInterval, "--list",
                            folder / "servers.json"});
  EXPECT_TRUE(directory.prints("maze-1 joined the fleet"))
      << directory.printed() << server.log() << nats->log();
  EXPECT_TRUE(
      waitUntil([&] { return contentOf(folder / "servers.json").find("\"maze-1\"") != std::string::npos; }));
}

}  // namespace
}  // namespace naiad::test
