// The other nodes' sessions that a participant knows, and the sessions that a node's name stands for.
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

    // Notes that a sample of the session has come. Called for each sample: mostly a single load.
    void Hear() const
    {
        if (IsSuperseded())
        {
            _superseded.store(false, std::memory_order_relaxed);
        }
    }
    // Notes that another session of the node has appeared.
    void Supersede() const { _superseded.store(true, std::memory_order_relaxed); }
    // True if no sample has come since another session of the node appeared.
    bool IsSuperseded() const { return _superseded.load(std::memory_order_relaxed); }

private:
    mutable std::atomic<bool> _superseded{false};
};

// A killed node stays known until its lease runs out, though its next incarnation may already be there.
// Samples written to the node go to the session that appeared last, and to those that were heard after that:
// two live nodes may have one name, or a forger may have announced a live node's name. The order of
// appearance decides, not the number of the incarnation, which falls if a clock is set back.
//
// Not thread-safe: guarded by its owner.
template <typename Id>
class PeerSessions
{
public:
    using Session = std::shared_ptr<const PeerSession>;

    // Adds a session. Null if it is already known.
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

    // Removes a session. Null if it is not known.
    Session Remove(const Id &id)
    {
        const auto found = _sessions.find(id);
        return found == _sessions.end() ? nullptr : std::move(_sessions.extract(found).mapped());
    }

    // Null if the session is not known.
    Session Find(const Id &id) const
    {
        const auto found = _sessions.find(id);
        return found == _sessions.end() ? nullptr : found->second;
    }

    // The sessions to which samples written to the node go.
    std::vector<Id> Of(const std::string &node) const
    {
        std::vector<Id> ids;
        VisitOf(node, [&](const Id &id) { ids.push_back(id); });
        return ids;
    }
    // The same, one after the other: visit(id).
    template <typename Visit>
    void VisitOf(const std::string &node, const Visit &visit) const
    {
        for (const auto &[id, session] : _sessions)
        {
            if (session->Node == node && !session->IsSuperseded())
            {
                visit(id);
            }
        }
    }

private:
    std::map<Id, Session> _sessions;
};

}  // namespace Rabit
