#include "common/HandshakeFragments.h"

#include <algorithm>
#include <optional>

#include "common/KeyExchangeStamp.h"
#include "common/RtpsReader.h"
#include "common/RtpsWriter.h"

namespace Rabit
{

using namespace Rtps;

namespace
{

// OMG DDSI-RTPS 2.3, 9.4.5.4: the body of a DATA_FRAG in front of its payload.
constexpr std::size_t FragmentHead = NumberInData + SequenceSize + 12;
constexpr std::uint16_t ToInlineQos = FragmentHead - 4;

}  // namespace

std::vector<std::vector<std::uint8_t>> CutHandshake(std::span<const std::uint8_t> datagram,
                                                    std::size_t largest)
{
    std::vector<std::uint8_t> head(
        datagram.begin(),
        datagram.begin() + static_cast<std::ptrdiff_t>(std::min(datagram.size(), RtpsHeaderSize)));
    std::optional<ConstSubmessage> data;
    VisitSubmessages(datagram,
                     [&](const ConstSubmessage &submessage)
                     {
                         if (submessage.Kind == SubmessageKind::Data)
                         {
                             data = submessage;
                         }
                         else if (!data)
                         {
                             Append(head, submessage.Whole);
                         }
                     });
    const std::size_t around = head.size() + SubmessageHeaderSize + FragmentHead + KeyExchangeStamp::Size;
    if (!data || (data->Flags & InlineQosFlag) != 0 || datagram.size() + KeyExchangeStamp::Size <= largest ||
        around >= largest)
    {
        return {};
    }
    RtpsReader body = data->Reader();
    body.Skip(2);  // extra flags
    const std::size_t toPayload = body.U16();
    const auto payload = body.Rest().subspan(std::min(toPayload, body.Left()));
    RtpsReader entities = data->Reader();
    entities.Skip(ReaderInData);
    const EntityId reader = entities.Entity();
    const EntityId writer = entities.Entity();
    const std::int64_t number = entities.Sequence();
    if (writer != HandshakeWriter || !entities.IsGood())
    {
        return {};
    }
    const std::size_t most = (largest - around) / 4 * 4;
    std::vector<std::vector<std::uint8_t>> pieces;
    for (std::size_t at = 0; at < payload.size() && most > 0; at += most)
    {
        const auto part = payload.subspan(at, std::min(most, payload.size() - at));
        std::vector<std::uint8_t> &piece = pieces.emplace_back(head);
        AppendSubmessageHeader(piece, SubmessageKind::DataFrag, FragmentHead + part.size());
        Append(piece, 0, 2);  // extra flags
        Append(piece, ToInlineQos, 2);
        AppendEntity(piece, reader);
        AppendEntity(piece, writer);
        AppendSequence(piece, number);
        Append(piece, pieces.size(), 4);  // the fragment's number
        Append(piece, 1, 2);              // how many are here
        Append(piece, most, 2);
        Append(piece, payload.size(), 4);
        Append(piece, part);
    }
    return pieces;
}

}  // namespace Rabit
