#include "shared/net/datagram/SealedLink.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "shared/values/LittleEndian.h"

namespace naiad {
namespace {

constexpr unsigned kHasChallenge = 1;
constexpr unsigned kHasAnswer = 2;
constexpr unsigned kHasPing = 4;
constexpr unsigned kHasEcho = 8;
constexpr std::size_t kFieldSize = sizeof(PathChallenge);

std::optional<PathChallenge> takeField(std::string_view& text) {
  if (text.size() < kFieldSize) return std::nullopt;
  const auto value = loadLittleEndian<PathChallenge>(text.data());
  text.remove_prefix(kFieldSize);
  return value;
}

std::optional<std::uint8_t> readByte(std::string_view& text) {
  if (text.empty()) return std::nullopt;
  const auto byte = static_cast<std::uint8_t>(text[0]);
  text.remove_prefix(1);
  return byte;
}

std::optional<LinkPing::Echo> popEcho(std::string_view& text) {
  const auto token = readByte(text);
  const auto held = readByte(text);
  if (!token || !held) return std::nullopt;
  return LinkPing::Echo{*token, *held};
}

}  // namespace

bool PathValidator::onPacket(const Path& path, std::size_t bytes, PathChallenge challenge) {
  const bool moved = current_ != path;
  if (moved) {
    current_ = path;
    validated_ = current_ == validated_path_;
    challenge_ = challenge;
    bytes_in_ = bytes_out_ = 0;
    challenged_.reset();
  }
  bytes_in_ += bytes;
  return moved;
}

void PathValidator::onLatePacket(const Path& path, std::size_t bytes) {
  if (current_ == path) bytes_in_ += bytes;
}

bool PathValidator::onResponse(PathChallenge answer) {
  if (!current_ || validated() || !challenged_ || answer != challenge_) return false;
  validated_path_ = current_;
  validated_ = true;
  return true;
}

void PathValidator::setUnvalidated(const Path& path) {
  current_ = validated_path_ = path;
  validated_ = true;
}

std::size_t PathValidator::budget() const {
  if (validated()) return std::numeric_limits<std::size_t>::max();
  const std::uint64_t allowed = kAmplification * bytes_in_;
  return allowed > bytes_out_ ? allowed - bytes_out_ : 0;
}

void PathValidator::onSent(std::size_t bytes, Time now) {
  if (validated()) return;
  bytes_out_ += bytes;
  challenged_ = now;
}

bool PathValidator::needsChallenge(Time now) const {
  return current_ && !validated() && (!challenged_ || now - *challenged_ >= kChallengeInterval);
}

SealedLink::SealedLink(Options options) : options_(std::move(options)) {
  assert(!isServer() || options_.random);
  if (!options_.scratch) options_.scratch = std::make_shared<SealScratch>();
}

// Epochs.

bool SealedLink::startEpoch(Epoch epoch, const DatagramKeys& keys, Time now) {
  if (newest_ && (epoch <= newest_->epoch || epoch - newest_->epoch > kEpochMask)) return false;
  const SealKey& own = isServer() ? keys.server : keys.client;
  const SealKey& other = isServer() ? keys.client : keys.server;
  previous_ = std::move(newest_);
  previous_until_ = previous_ ? now + kPreviousEpoch : Time::max();
  newest_.emplace(Keys{epoch, Sealer(own, options_.limits), Opener(other)});
  confirmed_ = isServer();
  return true;
}

std::optional<Epoch> SealedLink::epoch() const {
  return newest_ ? std::optional(newest_->epoch) : std::nullopt;
}

void SealedLink::expire(Time now) {
  if (now < previous_until_) return;
  previous_.reset();
  previous_until_ = Time::max();
}

SealedLink::Keys* SealedLink::sendingKeys() {
  if (!confirmed_ && previous_ && !previous_->sealer.exhausted()) return &*previous_;
  return newest_ && !newest_->sealer.exhausted() ? &*newest_ : nullptr;
}

SealedLink::Keys* SealedLink::findKeys(Epoch epoch_bits) {
  if (newest_ && (newest_->epoch & kEpochMask) == epoch_bits) return &*newest_;
  if (previous_ && (previous_->epoch & kEpochMask) == epoch_bits) return &*previous_;
  return nullptr;
}

// Receiving.

bool SealedLink::isPlausible(std::string_view packet, Time now) {
  return admit(packet, now) != nullptr;
}

/// Checks a packet without decrypting it, the cheapest checks first. Counts a refused one and returns null.
SealedLink::Keys* SealedLink::admit(std::string_view packet, Time now) {
  expire(now);
  SealedHeader header;
  if (const auto fault = readSealedHeader(receives(), packet, header); fault != HeaderFault::kNone) {
    ++(fault == HeaderFault::kTooShort  ? counters_.too_short
       : fault == HeaderFault::kTooLong ? counters_.too_long
                                        : counters_.bad_kind);
    return nullptr;
  }
  if (isServer() && header.id != options_.id) {
    ++counters_.wrong_id;
    return nullptr;
  }
  Keys* const keys = findKeys(header.epoch_bits);
  if (!keys) {
    ++counters_.unknown_epoch;
    return nullptr;
  }
  return accept(keys->opener.check(header.sequence)) ? keys : nullptr;
}

/// Returns true for kOpened; counts all other results and returns false.
bool SealedLink::accept(OpenResult result) {
  if (result == OpenResult::kOpened) return true;
  ++(result == OpenResult::kTooOld     ? counters_.too_old
     : result == OpenResult::kReplayed ? counters_.replayed
     : result == OpenResult::kForged   ? counters_.forged
                                       : counters_.exhausted);
  return false;
}

std::optional<std::string_view> SealedLink::open(const Path& path, std::string_view packet, Time now) {
  Keys* const keys = admit(packet, now);
  if (!keys) return std::nullopt;
  const std::size_t header = sealedHeaderSize(receives());
  std::uint64_t sequence = 0;
  if (!accept(keys->opener.open(packet, header, options_.scratch->opened.data(), sequence)))
    return std::nullopt;
  const auto fields = readFields({options_.scratch->opened.data(), packet.size() - header - kSealTagSize});
  if (!fields) {
    ++counters_.malformed;
    return std::nullopt;
  }
  ++counters_.opened;
  if (keys == &*newest_) confirmed_ = true;
  if (isServer()) onPath(path, packet.size(), {keys->epoch, sequence});
  if (fields->answer) onChallengeResponse(*fields->answer);
  if (fields->challenge) pending_answer_ = fields->challenge;
  if (fields->ping) echo_.onPing(*fields->ping, now);
  if (fields->echo) ping_.onEcho(*fields->echo, now);
  return fields->payload;
}

std::optional<SealedLink::Fields> SealedLink::readFields(std::string_view text) const {
  const auto flags = static_cast<unsigned char>(text[0]);
  text.remove_prefix(1);
  // Only servers challenge, only clients answer; only clients ping, only servers echo.
  if (flags & ~(isServer() ? kHasAnswer | kHasPing : kHasChallenge | kHasEcho)) return std::nullopt;
  Fields fields;
  if (flags & kHasChallenge && !(fields.challenge = takeField(text))) return std::nullopt;
  if (flags & kHasAnswer && !(fields.answer = takeField(text))) return std::nullopt;
  if (flags & kHasPing && !(fields.ping = readByte(text))) return std::nullopt;
  if (flags & kHasEcho && !(fields.echo = popEcho(text))) return std::nullopt;
  fields.payload = text;
  return fields;
}

void SealedLink::onPath(const Path& path, std::size_t bytes, std::pair<Epoch, std::uint64_t> number) {
  if (newest_number_ && number < *newest_number_) return validator_.onLatePacket(path, bytes);
  newest_number_ = number;
  const bool moves = validator_.current() != path;
  if (validator_.onPacket(path, bytes, moves ? options_.random() : 0)) ++counters_.path_changes;
}

void SealedLink::onChallengeResponse(PathChallenge answer) {
  ++(validator_.onResponse(answer) ? counters_.paths_validated : counters_.wrong_answers);
}

void SealedLink::setServerPath(const Path& path) {
  assert(!isServer());
  validator_.setUnvalidated(path);
}

// Sending.

std::size_t SealedLink::maxPayload() const {
  return kMaxDatagram - smallestSealedPacket(sends()) - kFieldSize;
}

/// Returns the number of bytes of the next packet that are not payload, without a ping or echo.
std::size_t SealedLink::overhead() const {
  const bool field = isServer() ? !validator_.validated() : pending_answer_.has_value();
  return smallestSealedPacket(sends()) + (field ? kFieldSize : 0);
}

std::optional<std::size_t> SealedLink::payloadBudget() const {
  if (!validator_.current() || !sendingKeys() || validator_.budget() < overhead()) return std::nullopt;
  return std::min(maxPayload(), validator_.budget() - overhead());
}

bool SealedLink::needsToSend(Time now) const {
  const bool due = isServer() ? validator_.needsChallenge(now) : pending_answer_.has_value();
  return due && payloadBudget().has_value();
}

std::optional<SealedLink::Outgoing> SealedLink::seal(std::string_view payload, Time now, char* memory) {
  assert(payload.size() <= maxPayload());
  expire(now);
  if (!validator_.current()) {
    ++counters_.no_path;
    return std::nullopt;
  }
  Keys* const keys = sendingKeys();
  if (!keys) {
    ++counters_.no_key;
    return std::nullopt;
  }
  if (payload.size() + overhead() > validator_.budget()) {
    ++counters_.over_budget;
    return std::nullopt;
  }
  char* const sealed = memory != nullptr ? memory : options_.scratch->sealed.data();
  const std::size_t prefix = writeSealedPrefix(sends(), keys->epoch, options_.id, sealed);
  char* const text = sealed + prefix + 2;
  const std::size_t least = payload.size() + overhead();
  const std::size_t fields = writeFields(text, std::min(kMaxDatagram, validator_.budget()) - least, now);
  std::copy(payload.begin(), payload.end(), text + fields);
  const std::size_t size = keys->sealer.seal(sealed, prefix, fields + payload.size());
  validator_.onSent(size, now);
  ++counters_.sealed;
  return Outgoing{*validator_.current(), {sealed, size}};
}

/// Writes flags and fields, and returns their size. `spare`: number of bytes left for a ping or echo.
std::size_t SealedLink::writeFields(char* out, std::size_t spare, Time now) {
  std::size_t size = 1;
  out[0] = 0;
  if (isServer() && !validator_.validated()) {
    out[0] = kHasChallenge;
    storeLittleEndian(validator_.challenge(), out + size);
    size += kFieldSize;
  } else if (!isServer() && pending_answer_) {
    out[0] = kHasAnswer;
    storeLittleEndian(*std::exchange(pending_answer_, std::nullopt), out + size);
    size += kFieldSize;
  }
  return size + writePing(out, out + size, spare, now);
}

std::size_t SealedLink::writePing(char* flags, char* out, std::size_t spare, Time now) {
  if (!isServer() && spare >= 1 && ping_.isRequested()) {
    *flags = static_cast<char>(*flags | kHasPing);
    out[0] = static_cast<char>(ping_.onSent(now));
    return 1;
  }
  const auto echo = isServer() && spare >= 2 ? echo_.popEcho(now) : std::nullopt;
  if (!echo) return 0;
  *flags = static_cast<char>(*flags | kHasEcho);
  out[0] = static_cast<char>(echo->token);
  out[1] = static_cast<char>(echo->held_millis);
  return 2;
}

}  // namespace naiad
