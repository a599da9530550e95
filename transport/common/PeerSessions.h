// The sessions of other nodes that a participant knows, and which of them a node's name stands for.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/ParticipantIdentity.h"

namespace Rabit
{

// A session of another node. Thread-safe.
class PeerSession : public ParticipantIdentity
{
public:
    explicit PeerSession(ParticipantIdentity identity) : ParticipantIdentity(std::move(identity)) {}

    // A sample of it has come. Called for each sample: a load in most cases.
    void Hear() const
    {
        if (IsSuperseded())
        {
            _superseded.store(false, std::memory_order_relaxed);
        }
    }
    // Another session of the node has appeared.
    void Supersede() const { _superseded.store(true, std::memory_order_relaxed); }
    // True if no sample has come since another session of the node appeared.
    bool IsSuperseded() const { return _superseded.load(std::memory_order_relaxed); }

private:
    mutable std::atomic<bool> _superseded{false};
};

// A node that was killed stays known until its lease runs out, while its next incarnation is there already.
// Samples written to the node go to the session that appeared last, and also to those that were heard
// after that: two live nodes of one name, or a live node whose name somebody else has announced. The order of
// appearance decides, not the number of the incarnation: a clock that was set back makes that number fall.
//
// Guarded by its owner.
template <typename Id>
class PeerSessions
{
public:
    using Session = std::shared_ptr<const PeerSession>;

    // Null if that session is known.
    Session Add(const Id &id, const ParticipantIdentity &identity)
    {
        if (_sessions.contains(id))
        {
            return nullptr;
        }
        for (const auto &[other, session] : _sessions)
        {
            if (session->Node == identity.Node)
            {
                session->Supersede();
            }
        }
        return _sessions.emplace(id, std::make_shared<const PeerSession>(identity)).first->second;
    }

    // Null if it was not known.
    Session Remove(const Id &id)
    {
        const auto found = _sessions.find(id);
        return found == _sessions.end() ? nullptr : std::move(_sessions.extract(found).mapped());
    }

    // Null if it is not known.
    Session Find(const Id &id) const
    {
        const auto found = _sessions.find(id);
        return found == _sessions.end() ? nullptr : found->second;
    }

    // Those to which goes what is written to the node.
    std::vector<Id> Of(const std::string &node) const
    {
        std::vector<Id> ids;
        for (const auto &[id, session] : _sessions)
        {
            if (session->Node == node && !session->IsSuperseded())
            {
                ids.push_back(id);
            }
        }
        return ids;
    }

private:
    std::map<Id, Session> _sessions;
};

}  // namespace Rabit
