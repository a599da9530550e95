#pragma once

#include <rabit/RabitQueueReceipt.h>
#include <rabit/RabitWorkspace.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "backfill/Mail.h"

namespace Rabit::Backfill
{

// Questions and answers on their way to other nodes. Used by one thread.
class Outbox
{
public:
    // The workspace must outlive the object. `wake` is called when an outcome is known, on any thread.
    Outbox(RabitWorkspace &workspace, RabitHandler wake) : _workspace(workspace), _wake(std::move(wake)) {}

    // False: it was refused at the call.
    bool Send(const std::string &node, const Answer &answer)
    {
        return Send(node, std::make_shared<Answer>(answer), std::nullopt);
    }
    bool Send(const std::string &node, const Question &question)
    {
        return Send(node, std::make_shared<Question>(question), question);
    }

    // Returns the questions that were not delivered, and forgets all messages with an outcome.
    std::vector<std::pair<std::string, Question>> TakeFailed()
    {
        std::vector<std::pair<std::string, Question>> failed;
        for (const Sent &sent : _sent)
        {
            const QueueOutcome outcome = sent.Receipt->Outcome();
            if (sent.Asked && outcome != QueueOutcome::Pending && outcome != QueueOutcome::Delivered)
            {
                failed.emplace_back(sent.Node, *sent.Asked);
            }
        }
        std::erase_if(_sent,
                      [](const Sent &sent) { return sent.Receipt->Outcome() != QueueOutcome::Pending; });
        return failed;
    }
    // Answers for that node that have no outcome yet.
    std::size_t Answers(const std::string &node) const
    {
        return static_cast<std::size_t>(std::count_if(_sent.begin(), _sent.end(),
                                                      [&node](const Sent &sent)
                                                      { return !sent.Asked && sent.Node == node; }));
    }

private:
    struct Sent
    {
        std::string Node;
        std::shared_ptr<RabitQueueReceipt> Receipt;
        std::optional<Question> Asked;  // empty: an answer
    };

    bool Send(const std::string &node, std::shared_ptr<RabitMessage> message, std::optional<Question> asked)
    {
        auto receipt = std::make_shared<RabitQueueReceipt>();
        receipt->ConnectOutcomeKnown(_wake);
        if (!_workspace.AddMessageToQueue(node + "/" + QueueName, std::move(message), receipt))
        {
            return false;
        }
        _sent.push_back({node, std::move(receipt), std::move(asked)});
        return true;
    }

    RabitWorkspace &_workspace;
    const RabitHandler _wake;
    std::deque<Sent> _sent;
};

}  // namespace Rabit::Backfill
