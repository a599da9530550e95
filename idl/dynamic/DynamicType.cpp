#include <rabit/dynamic/DynamicMessage.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <set>
#include <stdexcept>
#include <vector>

#include <rabit/dynamic/CdrBuilder.h>
#include "dynamic/FreshValue.h"
#include "dynamic/IdlTokens.h"
#include "dynamic/JsonEncoder.h"
#include "dynamic/JsonSink.h"
#include "dynamic/KeySink.h"
#include "dynamic/NormalSink.h"
#include "dynamic/ReadType.h"
#include "dynamic/TextSink.h"
#include "dynamic/Walk.h"
#include "model/Names.h"

namespace Rabit
{
namespace
{

// The largest text for a sample: the same bound as for allocation in decoding.
std::size_t MostText(std::size_t sampleSize)
{
    return Idl::CdrReader::MaxGrowth * sampleSize + Idl::CdrReader::Allowance;
}

// Keeps a type until the process ends, as the registry requires.
void Keep(const std::shared_ptr<const DynamicType> &type)
{
    static std::mutex mutex;
    static auto &kept = *new std::vector<std::shared_ptr<const DynamicType>>;
    const std::lock_guard lock(mutex);
    kept.push_back(type);
}

bool IsFixed(const Dynamic::Shape &root)
{
    std::set<const Dynamic::Shape *> seen{&root};
    std::vector<const Dynamic::Shape *> left{&root};
    while (!left.empty())
    {
        const Dynamic::Shape &shape = *left.back();
        left.pop_back();
        if (shape.What == Dynamic::Kind::String || shape.What == Dynamic::Kind::Sequence ||
            shape.What == Dynamic::Kind::Union)
        {
            return false;
        }
        const auto add = [&](const Dynamic::Shape *other)
        {
            if (other != nullptr && seen.insert(other).second)
            {
                left.push_back(other);
            }
        };
        add(shape.Element);
        for (const Dynamic::Part &part : shape.Parts)
        {
            add(part.Type);
        }
    }
    return true;
}

const DynamicMessage &Concrete(const DynamicType &type, const RabitMessage &message)
{
    if (!type.IsTypeOf(message))
    {
        throw std::invalid_argument("DynamicType " + type.Name() + ": the message is of another type");
    }
    return static_cast<const DynamicMessage &>(message);
}

// Parses JSON; a member that an object has twice is refused, since one of the two would be lost.
class JsonText
{
public:
    explicit JsonText(std::string_view text)
    {
        std::vector<std::set<std::string>> names;
        const auto look = [&](int, nlohmann::ordered_json::parse_event_t event, nlohmann::ordered_json &value)
        {
            using Event = nlohmann::ordered_json::parse_event_t;
            if (event == Event::object_start)
            {
                names.emplace_back();
            }
            else if (event == Event::object_end)
            {
                names.pop_back();
            }
            else if (event == Event::key && !names.back().insert(value.get_ref<const std::string &>()).second)
            {
                throw std::invalid_argument("an object names a member twice");
            }
            return true;
        };
        try
        {
            Value = nlohmann::ordered_json::parse(text, look);
        }
        catch (const nlohmann::ordered_json::exception &error)
        {
            // Cuts off the prefix with the library's name.
            const std::string_view what = error.what();
            Reason = "not JSON: " + std::string(what.substr(std::min(what.find("] ") + 2, what.size())));
        }
        catch (const std::invalid_argument &error)
        {
            Reason = error.what();
        }
    }

    nlohmann::ordered_json Value;
    std::string Reason;
};

// True if the word is a keyword in another case than IDL has it, which a name can be only if it is escaped.
bool IsKeywordInAnotherCase(std::string_view word)
{
    return word != "TRUE" && word != "FALSE" &&
           std::any_of(word.begin(), word.end(),
                       [](unsigned char letter) { return std::isupper(letter) != 0; }) &&
           RabitIdl::IsIdlKeyword(std::string(word));
}

// Recordings have texts for readers that know keywords in one case alone. A text that has no tokens stays as
// it is: the guard says why it is refused. Adds the names that it escapes.
std::string WithEscapedNames(std::string_view idlText, std::set<std::string> &escaped)
{
    std::string reason;
    std::string text;
    std::size_t copied = 0;
    for (const Dynamic::Token &token : Dynamic::TokensOf(idlText, reason))
    {
        if (token.What == Dynamic::Token::Kind::Word && IsKeywordInAnotherCase(token.Text))
        {
            const auto at = static_cast<std::size_t>(token.Text.data() - idlText.data());
            text += idlText.substr(copied, at - copied);
            text += '_';
            copied = at;
            escaped.emplace(token.Text);
        }
    }
    text += idlText.substr(copied);
    return text;
}

// The reason quotes the name that is wrong in the text with escaped names.
std::string AsWritten(std::string reason, const std::set<std::string> &escaped)
{
    for (const std::string &name : escaped)
    {
        const std::size_t at = reason.find("'_" + name + "'");
        reason.erase(at == std::string::npos ? reason.size() : at + 1, 1);
    }
    return reason;
}

}  // namespace

ParsedType DynamicType::Parse(std::string_view idlText, std::string_view typeName)
{
    ParsedType parsed;
    std::string name(typeName);
    std::set<std::string> escaped;
    std::string text = WithEscapedNames(idlText, escaped);
    auto shapes = Dynamic::ReadType(text, name, parsed.Reason);
    parsed.Reason = AsWritten(std::move(parsed.Reason), escaped);
    if (shapes)
    {
        parsed.Type =
            std::make_shared<const DynamicType>(std::move(name), std::move(text), std::move(shapes));
    }
    return parsed;
}

const MessageType *DynamicType::Register(const std::shared_ptr<const DynamicType> &type)
{
    const MessageType *registered = MessageTypeRegistry::Find(type->Name());
    if (registered == nullptr)
    {
        try
        {
            MessageTypeRegistry::Add(*type);
        }
        catch (const std::logic_error &)
        {
            return nullptr;  // another thread was faster, with a different text
        }
        registered = MessageTypeRegistry::Find(type->Name());
        if (registered == type.get())
        {
            Keep(type);
        }
    }
    return registered->IdlText() == type->IdlText() ? registered : nullptr;
}

const std::string &DynamicType::RosTypeHash() const
{
    return _shapes->RosTypeHash;
}

DynamicType::DynamicType(std::string name, std::string idlText, std::unique_ptr<const Dynamic::Shapes> shapes)
    : _name(std::move(name)), _idlText(std::move(idlText)), _shapes(std::move(shapes))
{
}

DynamicType::~DynamicType() = default;

std::optional<std::string> DynamicType::ToJson(std::span<const std::uint8_t> sample, Wide wide) const
{
    std::string json;
    json.reserve(8 * std::min<std::size_t>(sample.size(), 65536));
    Dynamic::JsonSink sink(json, MostText(sample.size()), wide == Wide::Text);
    return Dynamic::WalkSample(*_shapes->Root, sample, sink) ? std::optional(std::move(json)) : std::nullopt;
}

std::optional<std::string> DynamicType::ToText(std::span<const std::uint8_t> sample) const
{
    Idl::TextWriter text;
    text.Raw(_name);
    text.Raw(" ");
    Dynamic::TextSink sink(text, MostText(sample.size()));
    return Dynamic::WalkSample(*_shapes->Root, sample, sink) ? std::optional(text.Text()) : std::nullopt;
}

EncodedSample DynamicType::FromJson(std::string_view json) const
{
    const JsonText text(json);
    return text.Reason.empty() ? FromJsonValue(text.Value) : EncodedSample{std::nullopt, text.Reason};
}

EncodedSample DynamicType::FromJsonValue(const nlohmann::ordered_json &json) const
{
    Dynamic::CdrBuilder out;
    Dynamic::JsonEncoder encoder(out);
    return encoder.Put(*_shapes->Root, json) ? EncodedSample{out.Finish(), ""}
                                             : EncodedSample{std::nullopt, encoder.Reason()};
}

const std::vector<std::uint8_t> &DynamicType::DefaultSample() const
{
    std::call_once(_defaultOnce,
                   [this]
                   {
                       Dynamic::CdrBuilder out;
                       Dynamic::PutFresh(out, *_shapes->Root);
                       _default = out.Finish();
                   });
    return _default;
}

std::optional<std::size_t> DynamicType::FixedSize() const
{
    constexpr std::size_t encapsulation = 4;
    return IsFixed(*_shapes->Root) ? std::optional(DefaultSample().size() - encapsulation) : std::nullopt;
}

std::optional<std::vector<std::uint8_t>> DynamicType::Normalized(std::span<const std::uint8_t> sample) const
{
    Dynamic::CdrBuilder out;
    out.Reserve(sample.size() + Idl::MaxPadding);
    Dynamic::NormalSink sink(out);
    return Dynamic::WalkSample(*_shapes->Root, sample, sink) ? std::optional(out.Finish()) : std::nullopt;
}

std::unique_ptr<RabitMessage> DynamicType::Create() const
{
    return std::make_unique<DynamicMessage>(shared_from_this());
}

std::shared_ptr<RabitMessage> DynamicType::CreateShared() const
{
    return std::make_shared<DynamicMessage>(shared_from_this());
}

std::type_index DynamicType::CppType() const
{
    return typeid(DynamicMessage);
}

bool DynamicType::IsTypeOf(const RabitMessage &message) const
{
    return typeid(message) == typeid(DynamicMessage) &&
           IsSameAs(static_cast<const DynamicMessage &>(message).Type());
}

std::size_t DynamicType::SerializedSize(const RabitMessage &message) const
{
    return Concrete(*this, message).Sample().size();
}

std::size_t DynamicType::Serialize(const RabitMessage &message, std::span<std::uint8_t> buffer) const
{
    const std::vector<std::uint8_t> &sample = Concrete(*this, message).Sample();
    if (sample.size() > buffer.size())
    {
        return 0;
    }
    std::memcpy(buffer.data(), sample.data(), sample.size());
    return sample.size();
}

bool DynamicType::Deserialize(std::span<const std::uint8_t> bytes, RabitMessage &message) const
{
    return const_cast<DynamicMessage &>(Concrete(*this, message)).SetSample(bytes);
}

bool DynamicType::HasKey() const
{
    return _shapes->Root->HasKey;
}

bool DynamicType::KeyHashOf(std::span<const std::uint8_t> bytes, std::array<std::uint8_t, 16> &hash) const
{
    Idl::KeyHasher hasher(_shapes->KeyFitsHash);
    Dynamic::KeySink sink(hasher);
    if (!HasKey() || !Dynamic::WalkSample(*_shapes->Root, bytes, sink))
    {
        return false;
    }
    hash = hasher.Finish();
    return true;
}

const Dynamic::Shape &DynamicType::Root() const
{
    return *_shapes->Root;
}

bool DynamicType::IsSameAs(const DynamicType &other) const
{
    return this == &other || (_name == other._name && _idlText == other._idlText);
}

}  // namespace Rabit
