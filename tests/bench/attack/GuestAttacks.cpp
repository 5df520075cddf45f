// Attacks by guests that do what clients may do, but too often: chatters, held slots, noise for the log, and
// password guesses.
#include <vector>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {
namespace {

using namespace std::chrono_literals;

/// An attack whose guests come from addresses of one network.
class GuestAttack : public Attack {
 public:
  explicit GuestAttack(int network) : m_network(network) {}

  void begin(const Target& target) override {
    m_p_context = &target.context;
    m_port = target.server.port();
  }

 protected:
  /// Creates a guest with the n-th address.
  std::unique_ptr<Guest> invite(int n, const std::string& name, const std::string& password = "") const {
    return std::make_unique<Guest>(*m_p_context, m_port, addressIn(m_network, n),
                                   guestOptions(name, password));
  }

 private:
  int m_network;
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
};

class Chatters : public GuestAttack {
 public:
  explicit Chatters(int count) : GuestAttack(5), m_guests(static_cast<std::size_t>(count)) {}

  void update(Time now) override {
    const bool talk = now >= m_next_line;
    if (talk) m_next_line = now + kBetweenLines;
    for (std::size_t i = 0; i < m_guests.size(); ++i) {
      std::unique_ptr<Guest>& guest = m_guests[i];
      if (guest && guest->isOver()) {
        ++m_ended;
        guest.reset();
      }
      if (!guest && talk) guest = invite(static_cast<int>(i), "talker");
      if (!guest) continue;
      guest->update(now);
      if (talk && guest->state() == Guest::State::kPlaying) guest->session()->sendChat(longLine());
    }
  }
  void end() override {
    for (auto& guest : m_guests) guest.reset();
  }
  void addFindings(Findings& findings) override {
    findings.figures.emplace_back("chatters", m_guests.size());
    findings.figures.emplace_back("chatters_ended", m_ended);
  }

 private:
  static constexpr auto kBetweenLines = 125ms;  // time between two lines: more than twice the allowed rate

  std::vector<std::unique_ptr<Guest>> m_guests;
  Time m_next_line{};
  long long m_ended = 0;  // chatters whose session ended
};

class HeldPlaces : public GuestAttack {
 public:
  HeldPlaces() : GuestAttack(6) {}

  ServerSetup setup() const override {
    return {.arguments = {"--max-players", "10", "--max-per-address", std::to_string(kHeldAllowed)},
            .password = {}};
  }
  void update(Time now) override {
    if (!m_guest) {
      if (now < m_next) return;
      m_next = now + 300ms;
      m_guest = invite(0, kHeldName);
    }
    m_guest->update(now);
    if (m_guest->state() == Guest::State::kJoining) return;
    ++(m_guest->state() == Guest::State::kPlaying ? m_joined : m_refused);
    m_guest.reset();
  }
  void end() override { m_guest.reset(); }
  void addFindings(Findings& findings) override {
    findings.figures.emplace_back("joins", m_joined);
    findings.figures.emplace_back("joins_refused", m_refused);
  }

 private:
  std::unique_ptr<Guest> m_guest;
  Time m_next{};
  long long m_joined = 0;
  long long m_refused = 0;
};

class LogReader : public GuestAttack {
 public:
  explicit LogReader(LogFault fault) : GuestAttack(8), m_fault(fault) {}

  void begin(const Target& target) override {
    GuestAttack::begin(target);
    m_fault == LogFault::kStalls ? target.server.stallLog() : target.server.closeLog();
  }
  // Lets a player join and leave repeatedly, because the server logs a line each time.
  void update(Time now) override {
    if (m_guest) {
      m_guest->update(now);
      if (m_guest->state() == Guest::State::kPlaying) m_guest->session()->leave();
      if (m_guest->isOver()) m_guest.reset();
    } else if (now >= m_next) {
      m_next = now + 200ms;
      m_guest = invite(0, "noise");
    }
  }
  void end() override { m_guest.reset(); }

 private:
  LogFault m_fault;
  std::unique_ptr<Guest> m_guest;
  Time m_next{};
};

class PasswordCrowd : public GuestAttack {
 public:
  PasswordCrowd() : GuestAttack(7), m_guessers(80) {}

  ServerSetup setup() const override { return {.arguments = {}, .password = "the right one"}; }
  void update(Time now) override {
    for (std::size_t i = 0; i < m_guessers.size(); ++i) {
      auto& [guest, next] = m_guessers[i];
      if (!guest) {
        if (now < next) continue;
        guest = invite(static_cast<int>(i), "guesser", "a wrong one");
      }
      guest->update(now);
      if (!guest->isOver()) continue;
      const bool busy = guest->state() == Guest::State::kRefusedForNow;
      m_busy += busy ? 1 : 0;
      m_wrong += guest->state() == Guest::State::kRefused ? 1 : 0;
      guest.reset();
      next = now + (busy ? 300ms : 500ms);
    }
  }
  void end() override { m_guessers.clear(); }
  void addFindings(Findings& findings) override {
    findings.figures.emplace_back("guesses", m_wrong);
    findings.figures.emplace_back("busy", m_busy);
  }

 private:
  struct Guesser {
    std::unique_ptr<Guest> guest;
    Time next{};
  };
  std::vector<Guesser> m_guessers;
  long long m_wrong = 0;
  long long m_busy = 0;
};

}  // namespace

AttackPtr makeChatters(int count) {
  return std::make_unique<Chatters>(count);
}

AttackPtr makeHeldPlaces() {
  return std::make_unique<HeldPlaces>();
}

AttackPtr makeLogReader(LogFault fault) {
  return std::make_unique<LogReader>(fault);
}

AttackPtr makePasswordCrowd() {
  return std::make_unique<PasswordCrowd>();
}

}  // namespace bench::attack
