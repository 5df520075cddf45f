// Replaces shared/net/datagram/Seal.cpp and DatagramKeys.cpp: a page has no datagrams and needs no ciphers.
#include "shared/net/datagram/DatagramKeys.h"
#include "shared/net/datagram/Seal.h"

namespace naiad {

std::optional<AeadId> aeadFromWire(std::uint32_t) {
  return std::nullopt;
}

SealKey::~SealKey() {
  key.fill(0);
}

DatagramKeys deriveDatagramKeys(const KeyExporter&, AeadId, ConnectionId, Epoch) {
  return {};
}

void detail::CipherContextDeleter::operator()(evp_cipher_ctx_st*) const {}

std::uint64_t maxFailedOpens(AeadId) {
  return 0;
}

Sealer::Sealer(const SealKey&, SealLimits limits) : iv_{}, limits_(limits) {}

std::size_t Sealer::seal(char*, std::size_t, std::size_t) {
  return 0;
}

Opener::Opener(const SealKey&, std::uint64_t max_failures) : iv_{}, max_failures_(max_failures) {}

OpenResult Opener::check(std::uint16_t) const {
  return OpenResult::kExhausted;
}

OpenResult Opener::open(std::string_view, std::size_t, char*, std::uint64_t&) {
  return OpenResult::kExhausted;
}

}  // namespace naiad
