// Notifications to a service manager; a socket of the test plays the manager.
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "host/fleet/ServiceNotify.h"
#include "tests/support/TempFolder.h"

namespace naiad {
namespace {

using Time = ServiceNotify::Clock::time_point;
using std::chrono::milliseconds;

class ServiceNotifyTest : public testing::Test {
 protected:
  ServiceNotifyTest() { listenAt((base / "notify").string()); }
  ~ServiceNotifyTest() override {
    if (socket >= 0) ::close(socket);
  }
  /// Listens at `path`; a leading '@' means an abstract socket name.
  void listenAt(const std::string& path) {
    if (socket >= 0) ::close(socket);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::memcpy(address.sun_path, path.data(), path.size());
    if (path.front() == '@') address.sun_path[0] = '\0';
    socket = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0);
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
    ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), size), 0);
    variables["NOTIFY_SOCKET"] = path;
  }
  ServiceNotify::Variable variable() {
    return [this](const char* p_name) {
      const auto found = variables.find(p_name);
      return found == variables.end() ? nullptr : found->second.c_str();
    };
  }
  std::vector<std::string> heard() const {
    std::vector<std::string> all;
    char text[4096];
    for (ssize_t size = 0; (size = ::recv(socket, text, sizeof text, 0)) > 0;)
      all.emplace_back(text, static_cast<std::size_t>(size));
    return all;
  }
  static std::vector<std::string> texts(std::initializer_list<std::string> all) { return all; }

  const test::TempFolder base;
  int socket = -1;
  std::map<std::string, std::string> variables;
};

TEST_F(ServiceNotifyTest, SendsEachNotificationInOneDatagram) {
  ServiceNotify service(variable());
  ASSERT_TRUE(service.isActive());
  service.notifyReady();
  for (int times = 0; times < 2; ++times) service.notifyPlayers({.address = "two\nlines", .ids = {1}});
  service.notifyReloading(Time(std::chrono::microseconds(1'234'567)));
  service.notifyStopping();
  EXPECT_EQ(heard(), texts({"READY=1", "STATUS=two\\nlines, 1 player", "RELOADING=1\nMONOTONIC_USEC=1234567",
                            "STOPPING=1"}));
}

TEST_F(ServiceNotifyTest, SendsKeepAlivesTwicePerWatchdogTimeout) {
  variables["WATCHDOG_USEC"] = "1000000";
  variables["WATCHDOG_PID"] = std::to_string(getpid());
  ServiceNotify service(variable());
  for (int millis = 0; millis <= 2000; millis += 100) service.notifyTick(Time(milliseconds(millis)));
  EXPECT_EQ(heard(), std::vector<std::string>(5, "WATCHDOG=1")) << "at 0, 500, 1000, 1500 and 2000 ms";
}

TEST_F(ServiceNotifyTest, SendsKeepAlivesOnlyIfRequested) {
  for (const auto& [usec, pid] : std::vector<std::pair<std::string, std::string>>{
           {"", ""}, {"0", ""}, {"x", ""}, {"-5", ""}, {"1000000", "1"}, {"1000000", "x"}}) {
    variables.erase("WATCHDOG_USEC");
    variables.erase("WATCHDOG_PID");
    if (!usec.empty()) variables["WATCHDOG_USEC"] = usec;
    if (!pid.empty()) variables["WATCHDOG_PID"] = pid;
    ServiceNotify service(variable());
    service.notifyTick(Time(milliseconds(1)));
    EXPECT_EQ(heard(), texts({})) << usec << ", " << pid;
  }
}

TEST_F(ServiceNotifyTest, SupportsAbstractSockets) {
  listenAt("@naiad-notify-test-" + std::to_string(getpid()));
  ServiceNotify service(variable());
  service.notifyReady();
  EXPECT_EQ(heard(), texts({"READY=1"}));
}

TEST_F(ServiceNotifyTest, IsInactiveWithoutAServiceManager) {
  for (const std::string& path : {std::string("relative"), std::string("/nowhere/notify"), std::string("@"),
                                  std::string(), std::string(200, '/')}) {
    variables["NOTIFY_SOCKET"] = path;
    ServiceNotify service(variable());
    EXPECT_FALSE(service.isActive()) << path;
    service.notifyReady();
  }
  variables.clear();
  EXPECT_FALSE(ServiceNotify(variable()).isActive());
}

// A manager that does not read must not block the server: its socket holds only some datagrams.
TEST_F(ServiceNotifyTest, StalledManagerBlocksNothingAndLostStatusIsResent) {
  variables["WATCHDOG_USEC"] = "2";
  ServiceNotify service(variable());
  for (int i = 0; i < 100'000; ++i) service.notifyTick(Time(milliseconds(i)));
  service.notifyPlayers({.address = "lost", .ids = {}});
  EXPECT_LT(heard().size(), 100'000u);
  service.notifyPlayers({.address = "lost", .ids = {}});
  service.notifyTick(Time(milliseconds(100'000)));
  service.notifyStopping();
  EXPECT_EQ(heard(), texts({"STATUS=lost, 0 players", "WATCHDOG=1", "STOPPING=1"}))
      << "what was lost comes again";
}

}  // namespace
}  // namespace naiad
