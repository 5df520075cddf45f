// password80: 80 addresses guess, so that the queue of passwords to be compared is never empty.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "Attack.h"
#include "Guest.h"

namespace bench::attack {

class PasswordCrowd : public Attack {
 public:
  static constexpr int kAddresses = 80;

  ServerSetup setup() const override { return {.arguments = {}, .password = "the right one"}; }
  void begin(const Target& target) override;
  void update(Time now) override;
  void end() override;
  void addFindings(Findings& findings) override;

 private:
  struct Guesser {
    std::string address;
    std::unique_ptr<Guest> guest;
    Time next{};
  };
  asio::io_context* m_p_context = nullptr;
  std::uint16_t m_port = 0;
  std::vector<Guesser> m_guessers;
  long long m_wrong = 0;
  long long m_busy = 0;
};

}  // namespace bench::attack
