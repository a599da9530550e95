#include "common/KeyExchange.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/RtpsReader.h"

namespace Rabit
{

namespace
{

using Bytes = std::span<const std::uint8_t>;
using Rtps::ConstSubmessage;
using Rtps::EntityId;
using Rtps::RtpsReader;
using Rtps::SubmessageKind;

// OMG DDS Security 1.1
// 9.3.2.5: common beginning of the names of a handshake's steps.
constexpr std::string_view Steps = "DDS:Auth:PKI-DH:1.0+";
// 7.4.3.3: offset of the addressee of a message. Before it are the CDR header, the message's identity and
// that of the message it answers, each a GUID and a number.
constexpr std::size_t AddresseeAt = 4 + 2 * (16 + 8);
constexpr std::size_t LargestControl = 64;
// Have a protected counterpart (OMG DDS Security 1.1, 7.4.5), or are for the lookup of types (OMG DDS-XTypes
// 1.3, 7.6.3.3.4), which no node uses.
constexpr std::array<EntityId, 5> IdleWriters{Rtps::PublicationsWriter, Rtps::SubscriptionsWriter,
                                              Rtps::LivelinessWriter, 0x000300c3, 0x000301c3};

bool Has(Bytes bytes, std::size_t at, std::size_t size)
{
    return at <= bytes.size() && size <= bytes.size() - at;
}

// The content of a DATA or of the first of its fragments. Empty for other submessages, and if an inline QoS
// is present, which the vendors do not use for handshakes.
Bytes ContentOf(const ConstSubmessage &submessage)
{
    constexpr std::size_t FirstFragmentAt = Rtps::NumberInData + Rtps::SequenceSize;
    RtpsReader fragment = submessage.Reader();
    fragment.Skip(FirstFragmentAt);
    if ((submessage.Flags & Rtps::InlineQosFlag) != 0 ||
        (submessage.Kind == SubmessageKind::DataFrag && fragment.U32() != 1))
    {
        return {};
    }
    RtpsReader body = submessage.Reader();
    body.Skip(2);  // extra flags
    const std::size_t toInlineQos = body.U16();
    return body.Rest().subspan(std::min(toInlineQos, body.Left()));
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
    explicit Reader(Bytes datagram) { _found.From = Rtps::PrefixOf(datagram.subspan(Rtps::PrefixAt)); }
    void Read(const ConstSubmessage &submessage)
    {
        switch (submessage.Kind)
        {
            case SubmessageKind::InfoDestination:
                if (submessage.Body().size() >= _found.To.size())
                {
                    _found.To = Rtps::PrefixOf(submessage.Body());
                }
                break;
            case SubmessageKind::Data:
            case SubmessageKind::DataFrag:
                ReadWriter(submessage, Rtps::WriterInData);
                _isLarge = true;
                break;
            case SubmessageKind::HeartbeatFrag:
            case SubmessageKind::NackFrag:
            case SubmessageKind::AckNack:
            case SubmessageKind::Heartbeat:
            case SubmessageKind::Gap:
                ReadWriter(submessage, sizeof(EntityId));
                break;
            case SubmessageKind::SecurePrefix:
                _hasNeeded = true;
                ReadPrefix(submessage.Body());
                break;
            case SubmessageKind::SecureBody:
                _hasNeeded = true;
                _isLarge = _isLarge || submessage.Body().size() > LargestControl;
                break;
            case SubmessageKind::MessagePrefix:
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
    void ReadWriter(const ConstSubmessage &submessage, std::size_t writerAt)
    {
        RtpsReader body = submessage.Reader();
        body.Skip(writerAt);
        const EntityId writer = body.Entity();
        const std::uint64_t high = body.U32();
        const std::uint64_t number = high << 32 | body.U32();
        if (!body.IsGood())
        {
            return;
        }
        const bool isIdle = std::find(IdleWriters.begin(), IdleWriters.end(), writer) != IdleWriters.end();
        (isIdle ? _hasIdle : _hasNeeded) = true;
        SetSource(writer ^ static_cast<std::uint8_t>(submessage.Kind));
        if (_found.IsWhole || _hasHandshake || writer != Rtps::HandshakeWriter)
        {
            return;
        }
        _hasHandshake = true;
        _found.Number = number;
        const Bytes content =
            submessage.Kind == SubmessageKind::HeartbeatFrag ? Bytes() : ContentOf(submessage);
        _found.What = StepOf(content);
        _found.IsForOther =
            _found.To != KeyExchange::Prefix{} && Has(content, AddresseeAt, _found.To.size()) &&
            !std::equal(_found.To.begin(), _found.To.end(), content.subspan(AddresseeAt).begin());
    }
    // 9.5.2.3: key and session. 9.5.2.1.2: the keys that protect the exchange of keys have the number 0.
    void ReadPrefix(Bytes bytes)
    {
        RtpsReader body(bytes, false);
        body.Skip(4);  // kind of the key
        const std::uint32_t key = body.U32();
        const std::uint32_t session = body.U32();
        if (body.IsGood())
        {
            _hasKeys = _hasKeys || key == 0;
            SetSource(key != 0 ? key : session);
        }
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
    if (datagram.size() < Rtps::RtpsHeaderSize)
    {
        return std::nullopt;
    }
    Reader reader(datagram);
    Rtps::VisitSubmessages(datagram,
                           [&reader](const ConstSubmessage &submessage) { reader.Read(submessage); });
    return reader.Found();
}

}  // namespace Rabit
