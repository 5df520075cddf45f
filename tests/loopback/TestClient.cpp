#include "TestClient.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <utility>

namespace naiad::test {

namespace {

/// Returns the total time that this process's current threads were ready to run but did not (the second
/// number of /proc/PID/task/TID/schedstat); zero if the kernel does not report it.
std::chrono::nanoseconds runDelay() {
  std::int64_t sum = 0;
  for (const auto& thread : std::filesystem::directory_iterator("/proc/self/task")) {
    std::int64_t ran = 0;
    std::int64_t waited = 0;
    if (std::ifstream(thread.path() / "schedstat") >> ran >> waited) sum += waited;
  }
  return std::chrono::nanoseconds(sum);
}

}  // namespace

ClientSetup insecurely(const std::string& name) {
  ClientSetup setup;
  setup.options.name = name;
  setup.options.program = "test";
  setup.trust.insecure = true;
  return setup;
}

TestClient::TestClient(asio::io_context& context, std::uint16_t port, const ClientSetup& setup)
    : m_connection(context, ServerAddress{"127.0.0.1", port}, setup.options, setup.rejoin, setup.trust) {
  m_connection.onSession([this](ClientSession& session) {
    session.onBeforeSnapshot([this, &session](std::uint32_t tick) { record(session, tick); });
    m_whole = CompletenessTracker();
    session.onAfterSnapshot([this, &session](const SnapshotHeader& header, const AckWindow& acks) {
      m_whole.addSnapshot(header, acks, session.welcome().resume_state.value_or(ResumeState()).snapshot);
    });
  });
  if (!setup.sessions.empty()) {
    m_file.emplace(setup.sessions, m_connection.address().canonicalText(), setup.options.name,
                   std::chrono::system_clock::now());
    m_connection.setTokenStore(*m_file);
  }
  m_connection.start();
}

// When a snapshot of a new tick is about to be applied, the pictures of all ticks before it are final. The
// replica extrapolates the ticks that no snapshot corrected.
void TestClient::record(ClientSession& session, std::uint32_t tick) {
  const std::uint32_t known = session.clock().newestTick();
  if (!m_keep || known == 0 || tick == known) return;
  if (m_only_whole) {
    if (m_whole.isComplete()) m_pictures[m_whole.tick()] = session.replica().render(m_whole.tick());
    return;
  }
  for (std::uint32_t t = std::max(m_recorded + 1, known); t < tick; ++t)
    m_pictures[t] = session.replica().render(t);
  m_recorded = tick - 1;
}

void press(TestClient& client, df::Keyboard::Key key) {
  client.session().sendKey(key, df::KEY_PRESSED, Clock::now());
}

bool isOnDatagrams(TestClient& client) {
  return client.joined() && client.session().hasDatagrams(Clock::now()) &&
         client.session().counters().datagrams_in > 20;
}

bool lists(TestClient& client, const std::string& name) {
  const ClientSession* session = client.connection().session();
  return session != nullptr &&
         std::ranges::any_of(session->players(), [&](const PlayerLine& line) { return line.name == name; });
}

bool hasRead(TestClient& client, const std::string& text) {
  const ClientSession* session = client.connection().session();
  return session != nullptr && std::ranges::any_of(session->chat(), [&](const ChatEntry& entry) {
           return entry.text.find(text) != std::string::npos;
         });
}

std::optional<int> numberAfter(const std::string& row, const std::string& label) {
  const std::size_t at = row.find(label);
  if (at == std::string::npos) return std::nullopt;
  int number = 0;
  const char* p_begin = row.data() + at + label.size();
  const bool is_number = std::from_chars(p_begin, row.data() + row.size(), number).ec == std::errc();
  return is_number ? std::optional(number) : std::nullopt;
}

bool serveUntil(asio::io_context& context, const std::vector<TestClient*>& clients,
                const std::function<bool()>& done) {
  return timeUntil(context, clients, done).has_value();
}

std::optional<std::chrono::nanoseconds> timeUntil(asio::io_context& context,
                                                  const std::vector<TestClient*>& clients,
                                                  const std::function<bool()>& done) {
  constexpr std::chrono::nanoseconds kMaxTurn = std::chrono::milliseconds(10);
  auto now = Clock::now();
  const auto end = now + kPatience;
  const std::chrono::nanoseconds delay = runDelay();
  std::chrono::nanoseconds took{0};
  while (!done()) {
    if (now > end) return std::nullopt;
    for (TestClient* client : clients) client->connection().update(now);
    context.restart();
    context.run_one_for(std::chrono::milliseconds(5));
    const auto before = std::exchange(now, Clock::now());
    took += std::min<std::chrono::nanoseconds>(now - before, kMaxTurn);
  }
  // The wait is only an estimate, because several threads may wait at once, and an ended thread's wait is
  // forgotten. So at most half the time is deducted.
  return took -
         std::clamp<std::chrono::nanoseconds>(runDelay() - delay, std::chrono::nanoseconds(0), took / 2);
}

}  // namespace naiad::test
