#include "shared/net/base/AddressRange.h"

#include <charconv>
#include <system_error>

#include "shared/net/base/AddressPrefix.h"

namespace naiad {

namespace {

constexpr int kHouseholdBits = 64;  ///< of IPv6

int widthOf(const asio::ip::address& address) {
  return address.is_v4() ? 32 : 128;
}

std::optional<int> readBits(std::string_view text, int most) {
  int bits = -1;
  const char* const p_end = text.data() + text.size();
  const auto [p_read, error] = std::from_chars(text.data(), p_end, bits);
  if (error != std::errc() || p_read != p_end || bits < 0 || bits > most) return std::nullopt;
  return bits;
}

}  // namespace

AddressRange::AddressRange(const asio::ip::address& address, int bits)
    : m_ipv4(address.is_v4()),
      m_length(m_ipv4 ? kMappedBits + bits : bits),
      m_bytes(masked(bytesOf(address), m_length)) {}

AddressRange::Bytes AddressRange::bytesOf(const asio::ip::address& address) {
  if (address.is_v6()) return address.to_v6().to_bytes();
  return asio::ip::make_address_v6(asio::ip::v4_mapped, address.to_v4()).to_bytes();
}

AddressRange::Bytes AddressRange::masked(Bytes bytes, int length) {
  for (int i = 0; i < static_cast<int>(bytes.size()); ++i) {
    const int kept = length - 8 * i;
    if (kept <= 0) bytes[static_cast<std::size_t>(i)] = 0;
    if (kept > 0 && kept < 8)
      bytes[static_cast<std::size_t>(i)] &= static_cast<std::uint8_t>(0xff << (8 - kept));
  }
  return bytes;
}

std::optional<AddressRange> AddressRange::parse(std::string_view text) {
  const std::size_t slash = text.find('/');
  std::error_code error;
  const auto typed = asio::ip::make_address(std::string(text.substr(0, slash)), error);
  if (error || (typed.is_v6() && typed.to_v6().scope_id() != 0)) return std::nullopt;
  const asio::ip::address address = unmapped(typed);
  if (slash == std::string_view::npos) return around(address);
  auto bits = readBits(text.substr(slash + 1), widthOf(typed));
  if (bits && address.is_v4() && typed.is_v6()) *bits -= kMappedBits;
  if (!bits || *bits < 0) return std::nullopt;
  return AddressRange(address, *bits);
}

AddressRange AddressRange::around(const asio::ip::address& address) {
  const asio::ip::address own = unmapped(address);
  return AddressRange(own, own.is_v4() ? widthOf(own) : kHouseholdBits);
}

bool AddressRange::contains(const asio::ip::address& address) const {
  const asio::ip::address own = unmapped(address);
  return own.is_v4() == m_ipv4 && masked(bytesOf(own), m_length) == m_bytes;
}

std::string AddressRange::text() const {
  const asio::ip::address_v6 address(m_bytes);
  const std::string first =
      m_ipv4 ? asio::ip::make_address_v4(asio::ip::v4_mapped, address).to_string() : address.to_string();
  return m_ipv4 && bits() == 32 ? first : first + "/" + std::to_string(bits());
}

std::optional<asio::ip::address> endpointAddress(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') host = host.substr(1, host.size() - 2);
  std::error_code error;
  const auto address = asio::ip::make_address(std::string(host), error);
  return error ? std::nullopt : std::optional(unmapped(address));
}

}  // namespace naiad
