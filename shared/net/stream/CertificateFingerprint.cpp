// The only part of Fingerprint that needs OpenSSL, which a client in a browser lacks.
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/x509.h>

#include <stdexcept>

#include "shared/net/stream/Fingerprint.h"

namespace naiad {

Fingerprint Fingerprint::of(const x509_st& certificate) {
  unsigned char* der = nullptr;
  const int size = i2d_X509_PUBKEY(X509_get_X509_PUBKEY(&certificate), &der);
  Fingerprint result;
  unsigned int written = 0;
  const bool good = size > 0 && EVP_Digest(der, static_cast<std::size_t>(size), result.bytes_.data(),
                                           &written, EVP_sha256(), nullptr) == 1;
  OPENSSL_free(der);
  if (!good || written != result.bytes_.size()) throw std::runtime_error("A public key could not be hashed.");
  return result;
}

}  // namespace naiad
