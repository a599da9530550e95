#pragma once

#include <rabit/RabitMessage.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/dynamic/DynamicMessage.h>

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "FleetSession.h"

namespace Rabit::Tool
{

// The answers to messages that name a queue for them in the member `reply_to`, as with RabitRequests.
namespace Reply
{

using Json = nlohmann::ordered_json;

// Returns the type of that name from the file, or without one from a node of the fleet, whose announcements
// it awaits for `wait` seconds; registered. Null after the reason was reported.
std::shared_ptr<const DynamicType> TypeOf(const std::string &name, const std::string &file, double wait,
                                          FleetSession &session);
// Has the message ask for its answer: sets `reply_to` to that queue, and `id`, if it has such a member that
// is 0, to `id`. Returns why it cannot; empty if it does.
std::string Ask(DynamicMessage &message, const std::string &queue, std::uint32_t id);
// True if the answer may be that to the message: the two have the same `id`, or one has none.
bool IsTo(const Json &answer, const Json &message);
// Takes the members that a person expects in an answer of that type: an object. Returns why they do not fit.
std::string Expect(const std::shared_ptr<const DynamicType> &type, const std::string &json, Json &expected);
// True if the answer has all of these members with these values.
bool Has(const Json &answer, const Json &expected);

}  // namespace Reply

// The queue of this program in which the answers arrive. Main thread only.
class Replies
{
public:
    static constexpr const char *Queue = "Replies";

    // Adds the queue. The session's gateway, of node `node`, has to accept the answers there. `session` must
    // outlive the object.
    Replies(FleetSession &session, const std::string &node);

    // See Reply::Ask; the number is another one for each message.
    std::string Ask(DynamicMessage &message) { return Reply::Ask(message, _address, _nextId++); }
    // Waits until so many answers to that message have come, for `seconds` at most, and returns them.
    std::vector<Reply::Json> WaitFor(const DynamicMessage &message, std::size_t count, double seconds);

private:
    FleetSession &_session;
    const std::string _address;
    std::uint32_t _nextId;
    std::shared_ptr<RabitMessageQueue<std::shared_ptr<RabitMessage>>> _queue;
};

}  // namespace Rabit::Tool
