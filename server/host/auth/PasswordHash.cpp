#include "host/auth/PasswordHash.h"

#include <argon2.h>
#include <openssl/rand.h>

#include <array>

namespace naiad {
namespace {

constexpr std::string_view kPrefix = "$argon2id$";
constexpr std::size_t kSaltSize = 16;
constexpr std::size_t kHashSize = 32;
constexpr std::size_t kMaxText = 512;

[[noreturn]] void fail(int code) {
  throw PasswordError(std::string("The password cannot be hashed: ") + argon2_error_message(code) + ".");
}

}  // namespace

PasswordHash PasswordHash::of(std::string_view password, Cost cost) {
  if (password.empty()) throw PasswordError("The password is empty.");
  if (password.size() > kMaxPassword) {
    throw PasswordError("The password is longer than " + std::to_string(kMaxPassword) + " bytes.");
  }
  std::array<unsigned char, kSaltSize> salt{};
  if (RAND_bytes(salt.data(), salt.size()) != 1)
    throw PasswordError("Cannot get random numbers from the system.");
  std::array<char, kMaxText> text{};
  const int code = argon2id_hash_encoded(cost.passes, cost.memory_kib, 1, password.data(), password.size(),
                                         salt.data(), salt.size(), kHashSize, text.data(), text.size());
  if (code != ARGON2_OK) fail(code);
  return PasswordHash(text.data());
}

PasswordHash PasswordHash::fromText(std::string_view text) {
  while (text.ends_with('\n') || text.ends_with('\r')) text.remove_suffix(1);
  if (!text.starts_with(kPrefix)) return of(text);
  PasswordHash hash{std::string(text)};
  if (text.size() >= kMaxText) fail(ARGON2_DECODING_FAIL);
  hash.matches("");  // throws if the hash is invalid
  return hash;
}

bool PasswordHash::matches(std::string_view password) const {
  const bool possible = !password.empty() && password.size() <= kMaxPassword;
  const std::string_view guess = password.substr(0, kMaxPassword);
  const int code = argon2id_verify(text_.c_str(), guess.data() ? guess.data() : "", guess.size());
  if (code != ARGON2_OK && code != ARGON2_VERIFY_MISMATCH) fail(code);
  return possible && code == ARGON2_OK;
}

}  // namespace naiad
