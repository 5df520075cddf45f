#include <gtest/gtest.h>
#include <openssl/ssl.h>

#include "shared/net/stream/Fingerprint.h"
#include "tests/shared/net/TestIdentity.h"

namespace naiad::test {
namespace {

Fingerprint of(const TestIdentity& identity) {
  return Fingerprint::of(
      *SSL_CTX_get0_certificate(TlsContext::forServer(identity.certificate, identity.key)->get()));
}

TEST(Fingerprint, TextSurvivesTheRoundTrip) {
  const Fingerprint key = of(testIdentity());
  EXPECT_EQ(key.text().size(), 64u);
  EXPECT_EQ(Fingerprint::parse(key.text()), key);
  std::string upper = key.text();
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(Fingerprint::parse(upper), key);
}

TEST(Fingerprint, MalformedTextsAreRefused) {
  const std::string good = of(testIdentity()).text();
  std::string wrong = good;
  wrong[10] = 'g';
  for (const std::string& text : {std::string(), good.substr(1), good + "0", " " + good.substr(1), wrong})
    EXPECT_FALSE(Fingerprint::parse(text)) << text;
}

TEST(Fingerprint, IsTheHashOfTheSubjectPublicKeyInfo) {
  const TestIdentity& identity = testIdentity();
  const auto context = TlsContext::forServer(identity.certificate, identity.key);
  EVP_PKEY* const key = SSL_CTX_get0_privatekey(context->get());
  unsigned char* der = nullptr;
  const int size = i2d_PUBKEY(key, &der);
  unsigned char hash[32];
  EVP_Digest(der, static_cast<std::size_t>(size), hash, nullptr, EVP_sha256(), nullptr);
  OPENSSL_free(der);
  std::string text;
  for (const unsigned char byte : hash) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  EXPECT_EQ(of(identity).text(), text);
}

}  // namespace
}  // namespace naiad::test
