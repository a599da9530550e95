#pragma once

#include <rabit/RabitClock.h>
#include <rabit/gateway/FleetExplorer.h>
#include <rabit/transport/Transport.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "paths/PeersOverPaths.h"
#include "report/ProblemTexts.h"
#include "types/TypeQuestions.h"
#include "wire/NodeReports.h"

namespace Rabit
{

// A FleetExplorer, and the gateway's side of it. The gateway tells it nothing before its first use.
// Thread-safe.
class Exploration final : public FleetExplorer
{
public:
    // `wake` makes the gateway's thread call TakeRequests soon.
    explicit Exploration(std::function<void()> wake) : _wake(std::move(wake)) {}

    void BeWanted() { _wanted = true; }
    bool IsWanted() const { return _wanted; }

    std::vector<Node> Nodes() const override;
    std::vector<std::string> Tools() const override;
    void AskForType(const std::string &node, const std::string &type, std::uint64_t definition) override;
    std::optional<std::string> TypeText(std::uint64_t definition) const override;
    void AskForReport(const std::string &node, Report what, std::uint32_t argument) override;
    std::optional<Answer> TakeReport(const std::string &node, Report what) override;
    void LookForSubscribers(const std::vector<std::string> &messages) override;
    std::optional<std::map<std::string, Subscribers>> FoundSubscribers() const override;
    void Subscribe(const SubscribeRule &rule) override;
    void SetExpiry(const std::string &node, const std::string &queue,
                   std::chrono::milliseconds expire) override;
    bool WaitUntilTaken(std::chrono::nanoseconds limit) override;
    void SetOnChange(std::function<void()> onChange) override;

    // Sets the function that knows the links, and tells it all that SetExpiry was told; null: there are none
    // now. It is called with the lock held.
    using Expiry = std::function<void(const std::string &node, const std::string &queue,
                                      std::chrono::milliseconds expire)>;
    void SetLinks(Expiry links);

    struct Requests
    {
        std::vector<TypeQuestions::Wanted> Lacking;  // each time until AddText or AddReport
        std::vector<SubscribeRule> Subscriptions;
        std::optional<std::vector<std::string>> LookedFor;  // whose subscribers
    };
    // Gateway's thread only, as those that follow.
    Requests TakeRequests();
    void SetNodes(const PeersOverPaths &peers, const ProblemTexts &problems, const PostTime &now);
    void AddText(std::uint64_t definition, std::string text);
    void AddReport(const std::string &node, NodeReports::Name name, Answer answer);
    // The sessions are those of all paths.
    void FindSubscribers(const std::vector<std::string> &messages,
                         const std::vector<const TransportSession *> &sessions);
    // Call at the beginning of a unit of work, and pass the result to EndTurn at its end.
    std::uint64_t BeginTurn() const { return _turnsAsked; }
    void EndTurn(std::uint64_t asked);
    // False: no unit of work follows, so nobody waits for one. True, from the beginning: they follow again.
    void SetServed(bool isServed);

private:
    void Tell();

    const std::function<void()> _wake;
    std::atomic<bool> _wanted{false};
    mutable std::mutex _mutex;
    std::vector<Node> _nodes;
    std::vector<std::string> _tools;
    std::map<std::uint64_t, std::string> _texts;
    // By node and kind: the argument of the last request, and the answer to it.
    std::map<std::pair<std::string, NodeReports::Kind>, std::pair<std::uint32_t, std::optional<Answer>>>
        _reports;
    std::optional<std::map<std::string, Subscribers>> _subscribers;
    Requests _requests;
    // The requested texts that have not come. By definition, or by kind and node of a report.
    std::map<std::pair<std::uint64_t, std::string>, TypeQuestions::Wanted> _lacking;
    std::function<void()> _onChange;
    Expiry _links;
    std::vector<std::tuple<std::string, std::string, std::chrono::milliseconds>> _expiries;
    std::atomic<std::uint64_t> _turnsAsked{0};  // calls of WaitUntilTaken
    std::uint64_t _turnsDone = 0;               // those before the last whole unit of work began
    bool _isServed = true;
    std::condition_variable _turnDone;
};

}  // namespace Rabit
