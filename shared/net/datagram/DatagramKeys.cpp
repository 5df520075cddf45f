#include "shared/net/datagram/DatagramKeys.h"

#include <openssl/crypto.h>

#include <algorithm>

#include "shared/net/base/Limits.h"
#include "shared/values/LittleEndian.h"

namespace naiad {
namespace {

/// Moves key and IV from the front of `material` to `key`.
void take(std::string_view& material, SealKey& key) {
  const std::size_t size = aeadKeySize(key.aead);
  std::copy_n(material.begin(), size, key.key.begin());
  material.remove_prefix(size);
  std::copy_n(material.begin(), key.iv.size(), key.iv.begin());
  material.remove_prefix(key.iv.size());
}

}  // namespace

std::optional<AeadId> aeadFromWire(std::uint32_t number) {
  if (number == 1) return AeadId::kAes128Gcm;
  if (number == 2) return AeadId::kChaCha20Poly1305;
  return std::nullopt;
}

std::size_t aeadKeySize(AeadId aead) {
  return aead == AeadId::kAes128Gcm ? 16 : 32;
}

SealKey::~SealKey() {
  OPENSSL_cleanse(key.data(), key.size());
  OPENSSL_cleanse(iv.data(), iv.size());
}

std::string datagramKeyContext(AeadId aead, ConnectionId id, Epoch epoch) {
  std::string context(17, '\0');
  storeLittleEndian(kProtocolVersion, context.data());
  context[4] = static_cast<char>(aead);
  storeLittleEndian(id.value, context.data() + 5);
  storeLittleEndian(epoch, context.data() + 13);
  return context;
}

DatagramKeys deriveDatagramKeys(const KeyExporter& exporter, AeadId aead, ConnectionId id, Epoch epoch) {
  const std::size_t size = 2 * (aeadKeySize(aead) + kAeadIvSize);
  std::string material = exporter(kDatagramKeyLabel, datagramKeyContext(aead, id, epoch), size);
  if (material.size() != size) {
    throw KeyExportError("The TLS connection did not give the keys for datagrams.");
  }
  DatagramKeys keys;
  keys.client.aead = keys.server.aead = aead;
  std::string_view rest = material;
  take(rest, keys.client);
  take(rest, keys.server);
  OPENSSL_cleanse(material.data(), material.size());
  return keys;
}

}  // namespace naiad
