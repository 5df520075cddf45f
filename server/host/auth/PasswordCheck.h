// Checks the server's password without blocking the caller.
//
// A guess costs 64 MiB and 0.1 s by design. So guesses run on another thread, one at a time, from a short
// queue (PasswordQueue.h), and LoginRateLimit counts the wrong ones.
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

class JobThread;

/// Thread: that of `owner`, except for the worker inside. May be destroyed at any time, also in its own
/// callback. The destructor waits for the guess in progress; no callback is called afterwards.
class PasswordCheck {
 public:
  enum class Answer {
    kRight,
    kWrong,
    kTooMany,   ///< too many wrong guesses from this prefix lately; nothing was compared
    kBusy,      ///< too many guesses at once; not counted as wrong; retry later
    kNoMemory,  ///< too little memory to compare; not counted as wrong
  };
  struct Limits {
    std::size_t queue = 8;     ///< maximum number of guesses waiting or in progress; at least two
    int wrong_per_window = 5;  ///< maximum number of wrong guesses in a window, per IPv4 address or IPv6 /64
    std::chrono::seconds window{60};  ///< starts with the first guess
    /// Number of prefixes whose wrong guesses are counted, and of networks that wait or guessed wrong in the
    /// last hour (LoginRateLimit.h, PasswordQueue.h); then the least recently used is forgotten.
    std::size_t prefixes = 16'384;
  };
  struct Counters {
    std::uint64_t right = 0, wrong = 0, malformed = 0, too_many = 0, busy = 0;
  };

  /// `owner` runs the callbacks, and must outlive this. Call all members on its thread.
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash, Limits limits);
  PasswordCheck(asio::any_io_executor owner, PasswordHash hash)
      : PasswordCheck(std::move(owner), std::move(hash), Limits{}) {}
  ~PasswordCheck();

  /// Checks a password. `from`: the client's address prefix; `known`: it has players. `done` is called once,
  /// posted to the owner, never from inside check(). An empty or too long password (kMaxPassword) is kWrong,
  /// without a guess.
  void check(const AddressPrefix& from, bool known, std::string password,
             std::chrono::steady_clock::time_point now, std::function<void(Answer)> done);

  /// Changes the password, also for waiting guesses. Does not wait for the guess in progress.
  void setHash(PasswordHash hash);

  const Counters& counters() const;
  /// Number of address prefixes whose guesses are remembered (Limits::prefixes).
  std::size_t remembered() const;

 private:
  struct State;
  std::unique_ptr<JobThread> worker_;
  std::shared_ptr<State> state_;  // uses the worker
};

}  // namespace naiad
