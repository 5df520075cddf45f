#include "SealKit.h"

#include <openssl/core_names.h>
#include <openssl/evp.h>
#include <openssl/kdf.h>
#include <openssl/params.h>
#include <openssl/sha.h>

#include <memory>
#include <stdexcept>

namespace naiad::test {
namespace {

std::string sha256(std::string_view text) {
  std::string digest(SHA256_DIGEST_LENGTH, '\0');
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(),
         reinterpret_cast<unsigned char*>(digest.data()));
  return digest;
}

std::string hkdfExpand(std::string secret, std::string info, std::size_t size) {
  const std::unique_ptr<EVP_KDF, decltype(&EVP_KDF_free)> kdf(EVP_KDF_fetch(nullptr, "HKDF", nullptr),
                                                              EVP_KDF_free);
  const std::unique_ptr<EVP_KDF_CTX, decltype(&EVP_KDF_CTX_free)> context(EVP_KDF_CTX_new(kdf.get()),
                                                                          EVP_KDF_CTX_free);
  int mode = EVP_KDF_HKDF_MODE_EXPAND_ONLY;
  char digest[] = "SHA256";
  const OSSL_PARAM parameters[] = {
      OSSL_PARAM_construct_int(OSSL_KDF_PARAM_MODE, &mode),
      OSSL_PARAM_construct_utf8_string(OSSL_KDF_PARAM_DIGEST, digest, 0),
      OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_KEY, secret.data(), secret.size()),
      OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_INFO, info.data(), info.size()),
      OSSL_PARAM_construct_end()};
  std::string out(size, '\0');
  if (EVP_KDF_derive(context.get(), reinterpret_cast<unsigned char*>(out.data()), size, parameters) != 1)
    throw std::runtime_error("HKDF failed");
  return out;
}

std::string expandLabel(const std::string& secret, std::string_view label, std::string_view context,
                        std::size_t size) {
  const std::string full = "tls13 " + std::string(label);
  std::string info{static_cast<char>(size >> 8), static_cast<char>(size), static_cast<char>(full.size())};
  info += full;
  info += static_cast<char>(context.size());
  info += context;
  return hkdfExpand(secret, info, size);
}

}  // namespace

KeyExporter tlsExporter(std::string secret) {
  return [secret = std::move(secret)](std::string_view label, std::string_view context, std::size_t bytes) {
    const std::string derived = expandLabel(secret, label, sha256(""), SHA256_DIGEST_LENGTH);
    return expandLabel(derived, "exporter", sha256(context), bytes);
  };
}

KeyExporter knownExporter() {
  std::string secret;
  for (char i = 0; i < 32; ++i) secret += i;
  return tlsExporter(secret);
}

DatagramKeys knownKeys(AeadId aead, ConnectionId id, Epoch epoch) {
  return deriveDatagramKeys(knownExporter(), aead, id, epoch);
}

}  // namespace naiad::test
