#include "ResumeTokens.h"

#include <openssl/rand.h>
#include <openssl/sha.h>

#include <stdexcept>

namespace naiad {

namespace {

void fillRandom(void* out, int size) {
  if (RAND_bytes(static_cast<unsigned char*>(out), size) != 1) {
    throw std::runtime_error("The system gives no random numbers.");
  }
}

std::string hashOf(const std::string& token) {
  std::string hash(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(token.data()), token.size(),
         reinterpret_cast<unsigned char*>(hash.data()));
  return hash;
}

}  // namespace

std::string ResumeTokens::issue(std::uint64_t session) {
  forget(session);
  std::string token(kBytes, '\0');
  fillRandom(token.data(), static_cast<int>(token.size()));
  const std::string hash = hashOf(token);
  m_sessions[hash] = session;
  m_hashes[session] = hash;
  return token;
}

std::optional<std::uint64_t> ResumeTokens::redeem(const std::string& token) {
  if (token.size() != kBytes) return std::nullopt;
  const auto found = m_sessions.find(hashOf(token));
  if (found == m_sessions.end()) return std::nullopt;
  const std::uint64_t session = found->second;
  forget(session);
  return session;
}

void ResumeTokens::forget(std::uint64_t session) {
  const auto found = m_hashes.find(session);
  if (found == m_hashes.end()) return;
  m_sessions.erase(found->second);
  m_hashes.erase(found);
}

std::uint64_t randomBits() {
  std::uint64_t bits = 0;
  fillRandom(&bits, sizeof bits);
  return bits;
}

}  // namespace naiad
