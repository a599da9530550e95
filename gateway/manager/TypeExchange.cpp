#include "manager/TypeExchange.h"

#include <algorithm>
#include <limits>

#include "wire/LinkTopics.h"
#include "wire/TypeFrames.h"

namespace Rabit
{
namespace
{

// Bytes of a sample's body beside the text: the length of the frame, and its header.
constexpr std::size_t BodyOverhead = 4 + TypeFrames::HeaderSize;
constexpr std::size_t SmallestPart = 64;

}  // namespace

TypeExchange::TypeExchange(const GatewayConfig &config, Presence &presence, LinkDriver &links,
                           std::size_t path, std::function<void()> wake, OnText onText, ReportOf reportOf)
    : _presence(presence),
      _links(links),
      _path(path),
      _wake(std::move(wake)),
      _onText(std::move(onText)),
      _reportOf(std::move(reportOf)),
      _largestFrame(LargestLinkFrame(config.MaxDatagram, SomePathHasKeys(config))),
      _answers([this](std::uint64_t definition) { return TextOf(definition); })
{
    _links.AddOtherFrames(_path, TypeFrames::FirstByte,
                          [this](std::string_view node, std::span<const std::uint8_t> frame)
                          { OnFrame(node, frame); });
}

bool TypeExchange::Want(const TypeQuestions::Wanted &wanted, Duration now)
{
    const bool wants = _presence.TypesLacking().Want(wanted, now);
    _lacks = !_presence.TypesLacking().IsEmpty();
    return wants;
}

void TypeExchange::OnFrame(std::string_view node, std::span<const std::uint8_t> frame)
{
    {
        const std::lock_guard lock(_mutex);
        if (!_lacks || frame.size() > LargestInbox - _inboxBytes)
        {
            // A question for a report is repeated, so a second answer is not malformed.
            const auto part = TypeFrames::Decode(frame);
            _dropped += part && NodeReports::NameIn(part->Definition) ? 0 : 1;
            return;
        }
        _inboxBytes += frame.size();
        _inbox.emplace_back(node, std::vector<std::uint8_t>(frame.begin(), frame.end()));
    }
    _wake();
}

void TypeExchange::TakeInNews(const Presence::Served &served, Duration now)
{
    for (const auto &[node, question] : served.TypesAsked)
    {
        _answers.Asked(node, question.Definition, question.From, now);
    }
    if (!_lacks)
    {
        return;
    }
    std::vector<std::pair<std::string, std::vector<std::uint8_t>>> inbox;
    {
        const std::lock_guard lock(_mutex);
        inbox.swap(_inbox);
        _inboxBytes = 0;
    }
    for (const auto &[node, frame] : inbox)
    {
        const auto part = TypeFrames::Decode(frame);
        if (!part)
        {
            ++_dropped;
            continue;
        }
        if (std::optional<TypeQuestions::Answer> answer = _presence.TypesLacking().Add(node, *part))
        {
            _onText(node, part->Definition, std::move(*answer));
        }
    }
    _lacks = !_presence.TypesLacking().IsEmpty();
}

std::shared_ptr<const std::string> TypeExchange::TextOf(std::uint64_t definition)
{
    if (const std::string *text = _texts.Find(definition))
    {
        return {std::shared_ptr<void>(), text};  // lives as long as the process
    }
    const auto name = NodeReports::NameIn(definition);
    const std::optional<std::string> report = name ? _reportOf(*name) : std::nullopt;
    return report ? std::make_shared<std::string>(NodeReports::Sealed(*report)) : nullptr;
}

std::size_t TypeExchange::LargestPart(std::size_t mostBody) const
{
    const std::size_t most = std::min(mostBody, _largestFrame);
    return std::max(most - std::min(most, BodyOverhead), SmallestPart);
}

std::size_t TypeExchange::NextBody(std::size_t most) const
{
    return BodyOverhead + std::min(_answers.Next().Left(), LargestPart(most));
}

void TypeExchange::SendOne(std::size_t mostBody, Duration now)
{
    const TypeAnswers::Part next = _answers.Next();
    const std::size_t size = std::min(next.Left(), LargestPart(mostBody));
    TypeFrames::Part part;
    part.Definition = next.Definition;
    part.First = static_cast<std::uint32_t>(next.First);
    part.Of = static_cast<std::uint32_t>(next.Text->size());
    const auto *bytes = reinterpret_cast<const std::uint8_t *>(next.Text->data());
    part.Bytes = std::span(bytes, next.Text->size()).subspan(next.First, size);
    _links.SendOther(_path, next.Node, TypeFrames::Encode(part));
    _answers.Sent(size, now);
}

TypeExchange::Duration TypeExchange::Service(Duration now)
{
    std::optional<Duration> due = Due();
    while (due && *due <= now)
    {
        SendOne(std::numeric_limits<std::size_t>::max(), now);
        due = Due();
    }
    return due.value_or(Duration::max());
}

std::uint64_t TypeExchange::Malformed() const
{
    return _dropped + _presence.TypesLacking().Wrong();
}

}  // namespace Rabit
