#include "host/auth/ResumeTokens.h"

#include <openssl/rand.h>
#include <openssl/sha.h>

#include <stdexcept>

namespace naiad {

namespace {

void fillRandom(void* out, int size) {
  if (RAND_bytes(static_cast<unsigned char*>(out), size) != 1) {
    throw std::runtime_error("Cannot get random numbers from the system.");
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
  std::string token(kBytes, '\0');
  fillRandom(token.data(), static_cast<int>(token.size()));
  Hashes& hashes = m_hashes[session];
  if (hashes.newest != hashes.redeemed) drop(hashes.newest);
  hashes.newest = hashOf(token);
  m_sessions[hashes.newest] = session;
  return token;
}

std::optional<std::uint64_t> ResumeTokens::sessionOf(const std::string& hash) const {
  const auto found = m_sessions.find(hash);
  return found != m_sessions.end() ? std::optional(found->second) : std::nullopt;
}

std::optional<std::uint64_t> ResumeTokens::find(const std::string& token) const {
  return sessionOf(hashOf(token));
}

std::optional<std::uint64_t> ResumeTokens::findNewest(const std::string& token) const {
  const std::string hash = hashOf(token);
  const auto session = sessionOf(hash);
  return session && m_hashes.at(*session).newest == hash ? session : std::nullopt;
}

std::optional<std::uint64_t> ResumeTokens::redeem(const std::string& token) {
  const std::string hash = hashOf(token);
  const auto session = sessionOf(hash);
  if (!session) return std::nullopt;
  Hashes& hashes = m_hashes.at(*session);
  if (hashes.redeemed != hash) dropRedeemed(hashes);
  hashes.redeemed = hash;
  return session;
}

void ResumeTokens::confirm(std::uint64_t session) {
  const auto found = m_hashes.find(session);
  if (found == m_hashes.end() || found->second.redeemed == found->second.newest) return;
  dropRedeemed(found->second);
}

void ResumeTokens::dropRedeemed(Hashes& hashes) {
  if (hashes.restarted) {
    m_superseded.erase(hashes.superseded);
    m_superseded.insert(hashes.superseded = hashes.redeemed);
    hashes.restarted = false;
  }
  drop(hashes.redeemed);
}

void ResumeTokens::markSuperseded(std::uint64_t session) {
  const auto found = m_hashes.find(session);
  if (found != m_hashes.end()) found->second.restarted = !found->second.redeemed.empty();
}

bool ResumeTokens::isSuperseded(const std::string& token) const {
  return m_superseded.contains(hashOf(token));
}

ResumeTokens::Hashed ResumeTokens::hashed(std::uint64_t session) const {
  const auto found = m_hashes.find(session);
  return found != m_hashes.end() ? Hashed{found->second.newest, found->second.redeemed} : Hashed();
}

void ResumeTokens::restore(std::uint64_t session, const Hashed& hashed) {
  Hashes& hashes = m_hashes[session];
  hashes.newest = hashed.newest;
  hashes.redeemed = hashed.redeemed;
  for (const std::string* p_hash : {&hashes.newest, &hashes.redeemed}) {
    if (!p_hash->empty()) m_sessions[*p_hash] = session;
  }
}

void ResumeTokens::move(std::uint64_t from, std::uint64_t to) {
  const Hashed moved = hashed(from);
  forget(from);
  restore(to, moved);
}

void ResumeTokens::forget(std::uint64_t session) {
  const auto found = m_hashes.find(session);
  if (found == m_hashes.end()) return;
  drop(found->second.newest);
  drop(found->second.redeemed);
  m_superseded.erase(found->second.superseded);
  m_hashes.erase(found);
}

void ResumeTokens::drop(std::string& hash) {
  m_sessions.erase(hash);
  hash.clear();
}

std::uint64_t randomBits() {
  std::uint64_t bits = 0;
  fillRandom(&bits, sizeof bits);
  return bits;
}

}  // namespace naiad
