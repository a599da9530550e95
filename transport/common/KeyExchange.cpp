#include "common/KeyExchange.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/RtpsSubmessages.h"

namespace Rabit
{

namespace
{

using Bytes = std::span<const std::uint8_t>;
using Submessage = RtpsSubmessage<const std::uint8_t>;

// OMG DDSI-RTPS 2.3, 9.4.5
constexpr std::uint8_t InfoDestination = 0x0e;
constexpr std::uint8_t AckNack = 0x06;
constexpr std::uint8_t Heartbeat = 0x07;
constexpr std::uint8_t Gap = 0x08;
constexpr std::uint8_t HeartbeatFragment = 0x13;
constexpr std::uint8_t Data = 0x15;
constexpr std::uint8_t DataFragment = 0x16;
// OMG DDS Security 1.1, 7.3.6.1
constexpr std::uint8_t SecureBody = 0x30;
constexpr std::uint8_t SecurePrefix = 0x31;
constexpr std::uint8_t MessagePrefix = 0x33;

constexpr std::size_t PrefixAt = 8;  // in the header of a message
constexpr std::size_t NumberSize = 8;
// 7.4.4: BuiltinParticipantStatelessMessageWriter
constexpr std::array<std::uint8_t, 4> HandshakeWriter{0x00, 0x02, 0x01, 0xc3};
// 9.3.2.5: common beginning of the names of a handshake's steps.
constexpr std::string_view Steps = "DDS:Auth:PKI-DH:1.0+";
// 7.4.3.3: offset of the addressee of a message. Before it are the CDR header, the message's identity and
// that of the message it answers, each a GUID and a number.
constexpr std::size_t AddresseeAt = 4 + 2 * (16 + 8);
constexpr std::size_t LargestControl = 64;
// Writers of endpoints, of liveliness and of types (OMG DDSI-RTPS 2.3, 9.3.1.3; OMG
// DDS-XTypes 1.3, 7.6.3.3.4).
constexpr std::array<std::uint32_t, 5> IdleWriters{0x000003c2, 0x000004c2, 0x000200c2, 0x000300c3,
                                                   0x000301c3};

bool Has(Bytes bytes, std::size_t at, std::size_t size)
{
    return at <= bytes.size() && size <= bytes.size() - at;
}

std::uint32_t Read32(Bytes bytes, std::size_t at, bool littleEndian)
{
    std::uint32_t number = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        number = number << 8 | bytes[at + (littleEndian ? 3 - i : i)];
    }
    return number;
}

std::uint64_t ReadNumber(const Submessage &submessage, std::size_t at)
{
    return static_cast<std::uint64_t>(Read32(submessage.Body(), at, submessage.LittleEndian)) << 32 |
           Read32(submessage.Body(), at + 4, submessage.LittleEndian);
}

// The content of a DATA or of the first of its fragments. Empty for other submessages, and if an inline QoS
// is present, which the vendors do not use for handshakes.
Bytes ContentOf(const Submessage &submessage)
{
    constexpr std::size_t ToInlineQos = 2;  // octetsToInlineQos, which counts from behind itself
    constexpr std::size_t FirstFragmentAt = 20;
    constexpr std::uint8_t HasInlineQos = 0x02;
    const Bytes body = submessage.Body();
    if ((submessage.Flags & HasInlineQos) != 0 || !Has(body, ToInlineQos, 2) ||
        (submessage.Kind == DataFragment &&
         (!Has(body, FirstFragmentAt, 4) || Read32(body, FirstFragmentAt, submessage.LittleEndian) != 1)))
    {
        return {};
    }
    const std::size_t low = body[ToInlineQos + (submessage.LittleEndian ? 0 : 1)];
    const std::size_t high = body[ToInlineQos + (submessage.LittleEndian ? 1 : 0)];
    return body.subspan(std::min(ToInlineQos + 2 + (high << 8 | low), body.size()));
}

KeyExchange::Step StepOf(Bytes content)
{
    using Step = KeyExchange::Step;
    const std::string_view text(reinterpret_cast<const char *>(content.data()), content.size());
    const std::size_t at = text.find(Steps);
    const std::string_view name = at == std::string_view::npos ? "" : text.substr(at + Steps.size());
    return name.starts_with("Final")     ? Step::Final
           : name.starts_with("Reply")   ? Step::Reply
           : name.starts_with("AuthReq") ? Step::Ask
           : name.starts_with("Req")     ? Step::Request
                                         : Step::Rest;
}

class Reader
{
public:
    explicit Reader(Bytes datagram)
    {
        std::copy_n(datagram.begin() + PrefixAt, _found.From.size(), _found.From.begin());
    }
    void Read(const Submessage &submessage)
    {
        switch (submessage.Kind)
        {
            case InfoDestination:
                if (submessage.Body().size() >= _found.To.size())
                {
                    std::copy_n(submessage.Body().begin(), _found.To.size(), _found.To.begin());
                }
                break;
            case Data:
            case DataFragment:
                ReadWriter(submessage, 8);
                _isLarge = true;
                break;
            case HeartbeatFragment:
            case AckNack:
            case Heartbeat:
            case Gap:
                ReadWriter(submessage, 4);
                break;
            case SecurePrefix:
                _hasNeeded = true;
                ReadPrefix(submessage.Body());
                break;
            case SecureBody:
                _hasNeeded = true;
                _isLarge = _isLarge || submessage.Body().size() > LargestControl;
                break;
            case MessagePrefix:
                _found.IsWhole = true;
                break;
            default:
                break;
        }
    }
    std::optional<KeyExchange> Found()
    {
        _found.IsIdle = _hasIdle && !_hasNeeded;
        if (!_hasHandshake && !_hasKeys && !_found.IsWhole && !_found.IsIdle)
        {
            return std::nullopt;
        }
        if (!_hasHandshake)
        {
            _found.What = _isLarge ? KeyExchange::Step::Keys : KeyExchange::Step::Control;
        }
        return _found;
    }

private:
    void SetSource(std::uint32_t source)
    {
        if (!std::exchange(_hasSource, true))
        {
            _found.Source = source;
        }
    }
    void ReadWriter(const Submessage &submessage, std::size_t writerAt)
    {
        const Bytes body = submessage.Body();
        const std::size_t numberAt = writerAt + HandshakeWriter.size();
        if (!Has(body, numberAt, NumberSize))
        {
            return;
        }
        const std::uint32_t writer = Read32(body, writerAt, false);
        const bool isIdle = std::find(IdleWriters.begin(), IdleWriters.end(), writer) != IdleWriters.end();
        (isIdle ? _hasIdle : _hasNeeded) = true;
        SetSource(writer ^ submessage.Kind);
        if (_found.IsWhole || _hasHandshake ||
            !std::equal(HandshakeWriter.begin(), HandshakeWriter.end(),
                        body.subspan(writerAt, HandshakeWriter.size()).begin()))
        {
            return;
        }
        _hasHandshake = true;
        _found.Number = ReadNumber(submessage, numberAt);
        const Bytes content = submessage.Kind == HeartbeatFragment ? Bytes() : ContentOf(submessage);
        _found.What = StepOf(content);
        _found.IsForOther =
            _found.To != KeyExchange::Prefix{} && Has(content, AddresseeAt, _found.To.size()) &&
            !std::equal(_found.To.begin(), _found.To.end(), content.subspan(AddresseeAt).begin());
    }
    // 9.5.2.3: key and session. 9.5.2.1.2: the keys that protect the exchange of keys have the number 0.
    void ReadPrefix(Bytes body)
    {
        constexpr std::size_t KeyAt = 4;
        constexpr std::size_t SessionAt = 8;
        if (!Has(body, SessionAt, 4))
        {
            return;
        }
        const std::uint32_t key = Read32(body, KeyAt, false);
        _hasKeys = _hasKeys || key == 0;
        SetSource(key != 0 ? key : Read32(body, SessionAt, false));
    }

    KeyExchange _found;
    bool _hasHandshake = false;
    bool _hasKeys = false;
    bool _hasSource = false;
    bool _isLarge = false;
    bool _hasIdle = false;    // a submessage of one of IdleWriters
    bool _hasNeeded = false;  // any other submessage of a writer or reader
};

}  // namespace

std::optional<KeyExchange> ReadKeyExchange(std::span<const std::uint8_t> datagram)
{
    if (datagram.size() < RtpsHeaderSize)
    {
        return std::nullopt;
    }
    Reader reader(datagram);
    VisitSubmessages(datagram, [&reader](const Submessage &submessage) { reader.Read(submessage); });
    return reader.Found();
}

}  // namespace Rabit
