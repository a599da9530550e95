#pragma once

#include <rabit/RabitManager.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace Rabit
{

// The end of a request.
enum class RequestEnd
{
    Answered,      // a reply came
    NotDelivered,  // the request did not reach the queue, see Delivery
    NoReply        // no reply came in time
};

// For logs: `answered`, `not delivered`, `no reply`.
inline const char *ToString(RequestEnd end)
{
    return end == RequestEnd::Answered       ? "answered"
           : end == RequestEnd::NotDelivered ? "not delivered"
                                             : "no reply";
}

// The open requests of a manager: messages that it adds to queues, of this process or of other nodes. Each is
// answered by a message of class Reply in a queue of the manager. Each request ends exactly once.
//
// A reply may be refused at the call for a second or two, while the announcement of a node that has just
// started is missing. The manager that answers keeps such a reply, and adds it again in a later unit of work.
//
// The message types are the program's. Request and reply carry the number of the request, in any field.
//
//     auto request = std::make_shared<Survey>();
//     request->id = _requests.NextId();
//     request->reply_to = "ground/Surveyor";
//     _requests.Send("uav1/MissionControl", request);
//     ...
//     if (auto reply = std::dynamic_pointer_cast<SurveyReply>(message))
//         _requests.Take(reply->id, reply);
//     for (const auto &request : _requests.TakeEnded())
//         std::cout << request.Id << ": " << ToString(request.End);
//
// A request that was refused on its way wakes the manager. A timeout does not: it is seen at the manager's
// next pass, which its period or delay brings. Not thread-safe: for the manager's unit of work.
template <typename Reply>
class RabitRequests
{
public:
    struct Ended
    {
        std::uint32_t Id = 0;
        std::string Queue{};
        RequestEnd End = RequestEnd::NoReply;
        QueueOutcome Delivery = QueueOutcome::Pending;  // what is known of the request itself
        std::shared_ptr<const Reply> Answer{};          // null unless it was answered
    };

    // The manager must outlive the object. The first number is random, from 1 to 2^31: late replies to an
    // earlier run of the program have other numbers.
    RabitRequests(RabitManager &manager, std::chrono::nanoseconds timeout)
        : RabitRequests(manager, timeout, 1 + std::random_device()() / 2)
    {
    }
    // The first number is given. A program that restarts begins with one that its former requests did not
    // have.
    RabitRequests(RabitManager &manager, std::chrono::nanoseconds timeout, std::uint32_t firstId)
        : _manager(manager), _timeout(timeout), _nextId(firstId)
    {
    }

    // The number that the next request gets.
    std::uint32_t NextId() const { return _nextId; }
    // Adds the request to the queue. False: it was refused at the call (see
    // RabitWorkspace::AddMessageToQueue); it is not open, and NextId is unchanged.
    template <typename Request>
    bool Send(const std::string &queue, std::shared_ptr<Request> request)
    {
        auto receipt = std::make_shared<RabitQueueReceipt>();
        _manager.WakeUpManagerOnOutcome(receipt);
        if (!_manager.AddMessageToQueue(queue, std::move(request), receipt))
        {
            return false;
        }
        _open.emplace(_nextId++, Open{queue, std::move(receipt), Now() + _timeout, nullptr});
        return true;
    }
    // Notes a reply. False: it answers no open request: it came too late, twice, or from an earlier run.
    bool Take(std::uint32_t id, std::shared_ptr<const Reply> reply)
    {
        const auto found = _open.find(id);
        if (found == _open.end() || found->second.Answer)
        {
            return false;
        }
        found->second.Answer = std::move(reply);
        return true;
    }
    // The requests that ended since the last call, by number.
    std::vector<Ended> TakeEnded()
    {
        std::vector<Ended> ended;
        for (auto at = _open.begin(); at != _open.end();)
        {
            const Open &open = at->second;
            const QueueOutcome delivery = open.Receipt->Outcome();
            const bool lost = delivery == QueueOutcome::Expired || delivery == QueueOutcome::Refused;
            if (!open.Answer && !lost && Now() < open.EndsAt)
            {
                ++at;
                continue;
            }
            const RequestEnd end = open.Answer ? RequestEnd::Answered
                                   : lost      ? RequestEnd::NotDelivered
                                               : RequestEnd::NoReply;
            ended.push_back({at->first, open.Queue, end, delivery, open.Answer});
            at = _open.erase(at);
        }
        return ended;
    }
    std::size_t NumberOfOpen() const { return _open.size(); }

private:
    struct Open
    {
        std::string Queue;
        std::shared_ptr<RabitQueueReceipt> Receipt;
        std::chrono::nanoseconds EndsAt;
        std::shared_ptr<const Reply> Answer;
    };
    std::chrono::nanoseconds Now() const { return _manager.GetWorkspace().GetClock().Monotonic(); }

    RabitManager &_manager;
    const std::chrono::nanoseconds _timeout;
    std::uint32_t _nextId;
    std::map<std::uint32_t, Open> _open;
};

}  // namespace Rabit
