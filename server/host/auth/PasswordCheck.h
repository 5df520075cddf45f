// Checks the server's password without blocking the caller.
//
// A guess costs 64 MiB and 0.1 s by design. So guesses run on another thread, one at a time, from a short
// queue (PasswordQueue.h), and LoginRateLimit counts the wrong ones. Invalid passwords cost
// neither.
#pragma once

#include <asio/any_io_executor.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "host/auth/PasswordHash.h"
#include "shared/net/base/AddressPrefix.h"

namespace naiad {

/// Thread: that of `owner`, except for the worker inside. May be destroyed at any time, also in its own
/// callback. The destructor waits for the guess in progress; no callback comes afterwards.
class PasswordCheck {
 public:
  enum class Answer {
    kRight,
    kWrong,
    kTooMany,  ///< too many wrong guesses from this prefix lately; nothing was compared
    kBusy,     ///< too many guesses at once; nothing was compared or counted; retry after a second
  };
  struct Limits {
    std::size_t queue = 8;            ///< guesses waiting or in progress; at least two
    int wrong_per_window = 5;         ///< per IPv4 address or IPv6 /64; right ones do not count
    std::chrono::seconds window{60};  ///< starts with the first guess
    std::size_t prefixes = 1024;      ///< prefixes remembered; then the least recently used is forgotten
  };
  struct Counters {
    std::uint64_t right = 0, wrong = 0, unfit = 0, too_many = 0, busy = 0;
  };

  /// `owner` runs the callbacks, and must outlive this. Call all members there.
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash, Limits limits);
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash)
      : PasswordCheck(std::move(owner), std::move(hash), Limits{}) {}
  ~PasswordCheck();

  /// `from`: the client's address prefix; `known`: it has players. `done` is called once, posted to the
  /// owner, never from inside check(). An empty or too long password (kMaxPassword) is
  /// kWrong at once and no guess.
  void check(const AddressPrefix& from, bool known, std::string password,
             std::chrono::steady_clock::time_point now, std::function<void(Answer)> done);

  /// Changes the password, also for waiting guesses. Never waits for a guess.
  void setHash(PasswordHash hash);

  const Counters& counters() const;
  /// Number of prefixes remembered.
  std::size_t remembered() const;

 private:
  struct State;
  class Worker;
  std::unique_ptr<Worker> worker_;
  std::shared_ptr<State> state_;  // uses the worker
};

}  // namespace naiad
