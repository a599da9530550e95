#include "Replies.h"

#include <rabit/RabitEvent.h>

#include <random>
#include <utility>

#include "FleetType.h"
#include "IdlFiles.h"
#include "Offers.h"
#include "Output.h"

namespace Rabit::Tool
{
namespace Reply
{
namespace
{

// Numbers of 64 bits may be texts.
std::string TextOf(const Json &value)
{
    return value.is_string() ? value.get<std::string>() : value.dump();
}

ParsedType FromFleet(const std::string &name, double wait, FleetSession &session)
{
    const auto definitions = [&]
    {
        const auto types = Offers::TypesOf(session.Nodes());
        const auto found = types.find(name);
        return found == types.end() ? Offers::Definitions() : found->second;
    };
    session.WaitForOffers("*", [&] { return !definitions().empty(); });
    const Offers::Definitions all = definitions();
    if (all.size() != 1)
    {
        return {nullptr, (all.empty() ? "nobody announces a type `"
                                      : "nodes were built with different definitions of `") +
                             name + "`: --idl FILE names a text of it"};
    }
    const auto &[definition, holders] = *all.begin();
    const FleetType type =
        FetchType(session, {holders.begin(), holders.end()}, name, definition, session.Seconds() + wait);
    return {type.Type, type.Reason};
}

}  // namespace

std::shared_ptr<const DynamicType> TypeOf(const std::string &name, const std::string &file, double wait,
                                          FleetSession &session)
{
    ParsedType found = file.empty() ? FromFleet(name, wait, session) : IdlFiles({file}).Find(name);
    if (found.Type && DynamicType::Register(found.Type) == nullptr)
    {
        found = {nullptr, "this program has another definition of `" + name + "`"};
    }
    if (!found.Type)
    {
        Output::Talk(found.Reason);
    }
    return found.Type;
}

std::string Ask(DynamicMessage &message, const std::string &queue, std::uint32_t id)
{
    Json value = Json::parse(message.ToJson(), nullptr, false);
    const auto replyTo = value.find("reply_to");
    if (replyTo == value.end() || !replyTo->is_string())
    {
        return "`" + message.Type().Name() + "` has no text `reply_to`: it cannot ask for an answer";
    }
    if (!replyTo->get<std::string>().empty())
    {
        return "`reply_to` names `" + replyTo->get<std::string>() +
               "`, where the answer goes; --reply needs it empty";
    }
    *replyTo = queue;
    if (const auto number = value.find("id"); number != value.end() && TextOf(*number) == "0")
    {
        *number = id;
    }
    return message.SetJson(value.dump());
}

bool IsTo(const Json &answer, const Json &message)
{
    const auto number = answer.find("id");
    const auto asked = message.find("id");
    return answer.is_object() &&
           (number == answer.end() || asked == message.end() || TextOf(*number) == TextOf(*asked));
}

std::string Expect(const std::shared_ptr<const DynamicType> &type, const std::string &json, Json &expected)
{
    DynamicMessage whole(type);
    if (std::string misfit = whole.SetJson(json); !misfit.empty())
    {
        return misfit;
    }
    // As answers write them: a number may be given for the name of an enumerator.
    const Json written = Json::parse(whole.ToJson(), nullptr, false);
    const Json given = Json::parse(json, nullptr, false);
    expected = Json::object();
    for (const auto &[name, value] : given.items())
    {
        if (const auto member = written.find(name); member != written.end())
        {
            expected[name] = *member;
        }
    }
    return "";
}

bool Has(const Json &answer, const Json &expected)
{
    for (const auto &[name, value] : expected.items())
    {
        const auto member = answer.find(name);
        if (member == answer.end() || *member != value)
        {
            return false;
        }
    }
    return true;
}

}  // namespace Reply

// The first number is random, as that of RabitRequests: a late answer to an earlier run has another one.
Replies::Replies(FleetSession &session, const std::string &node)
    : _session(session),
      _address(node + "/" + Queue),
      _nextId(1 + std::random_device()() / 2),
      _queue(std::make_shared<RabitMessageQueue<std::shared_ptr<RabitMessage>>>(1000, Queue))
{
    _queue->ConnectSomethingEnqueued(RabitQuickHandler([&session] { session.Notify(); }));
    _session.Workspace().AddManagerMessageQueue(Queue, _queue);
}

std::vector<Reply::Json> Replies::WaitFor(const DynamicMessage &message, std::size_t count, double seconds)
{
    const Reply::Json asked = Reply::Json::parse(message.ToJson(), nullptr, false);
    std::vector<Reply::Json> answers;
    _session.WaitUntil(
        _session.Seconds() + seconds,
        [&]
        {
            std::shared_ptr<RabitMessage> received;
            while (answers.size() < count && _queue->GetMessage(received))
            {
                const auto *const dynamic = dynamic_cast<const DynamicMessage *>(received.get());
                Reply::Json answer = Reply::Json::parse(dynamic ? dynamic->ToJson() : "", nullptr, false);
                if (Reply::IsTo(answer, asked))
                {
                    answers.push_back(std::move(answer));
                }
            }
            return answers.size() >= count;
        });
    return answers;
}

}  // namespace Rabit::Tool
