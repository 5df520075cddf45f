// The files of deploy/fleet/make-fleet: a TLS bus on which each program may use only its own subjects, tested
// with the real nats-server, directory and server.
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "BusFixture.h"
#include "shared/fleet/BusPayloads.h"
#include "tests/loopback/GameProgram.h"
#include "tests/support/RunningProgram.h"

namespace naiad::test {
namespace {

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
