#pragma once

#include <rabit/RabitHandlerThread.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/gateway/GatewayManager.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "clocks/SourceClock.h"
#include "foreign/ForeignTopics.h"
#include "gateway.idl.h"
#include "incarnation/IncarnationStore.h"
#include "manager/AgreementDriver.h"
#include "manager/Exploration.h"
#include "manager/GatewayPath.h"
#include "manager/NodeSecurity.h"
#include "mirrors/Subscriptions.h"
#include "paths/PathChoice.h"
#include "paths/PeersOverPaths.h"
#include "presence/OriginTable.h"
#include "presence/RemoteQueues.h"
#include "presence/Whereabouts.h"
#include "queues/LinkDriver.h"
#include "queues/OutgoingQueues.h"
#include "report/FullQueues.h"
#include "report/HandlerWatch.h"
#include "report/LinkStrains.h"
#include "report/OwnLog.h"
#include "report/ProblemLog.h"
#include "report/ProblemTexts.h"
#include "wire/NodeReports.h"

namespace Rabit
{

// The parts of a gateway, and the order in which they serve, start and end. GatewayPartsReports.cpp has what
// the gateway tells of itself and of the others. Used by the gateway's thread alone.
class GatewayManager::Parts
{
public:
    // The object exists once the delegate returns. So if Open throws, whatever it is, the destructor closes
    // what was opened, endpoints before the session.
    Parts(const GatewayConfig &config, const std::vector<std::shared_ptr<Transport>> &transports,
          GatewayManager &manager, const RandomSource &random, Exploration &exploration);

    ~Parts();
    bool IsOpen() const { return _isOpen; }

    // Leaves the network, for good.
    void Close();

    // Returns when to be called again at the latest.
    std::chrono::nanoseconds Service();

    std::chrono::nanoseconds Now() const { return _workspace.GetClock().Monotonic(); }

private:
    using Duration = std::chrono::nanoseconds;

    struct Closed
    {
    };
    // The changes that all paths together have heard of in a turn.
    struct Heard
    {
        bool State = false;
        bool NewLife = false;
        bool Offers = false;
    };

    Parts(Closed /*tag*/, const GatewayConfig &config,
          const std::vector<std::shared_ptr<Transport>> &transports, GatewayManager &manager,
          const RandomSource &random, Exploration &exploration);
    void MakePaths(const std::vector<std::shared_ptr<Transport>> &transports, const RandomSource &random);

    // Takes in the changes that a path has heard of.
    void TakeIn(std::size_t path, const PeerTable::Change &heard, Heard &change);

    // An announcement that has come by one path need not come by the others.
    void ShareOffers(const PeerTable::Peer &peer, Presence &beats, Heard &change);
    void Forget(const std::string &node, std::size_t path);
    void LookAtBeats(Duration now);
    void ChoosePaths(Heard &change, Duration now);

    // Compares the announcements with the subscriptions.
    void MatchSubscriptions();
    void Open();
    void OpenSession();
    void SetExplored(Duration now);

    // Serves the requests of FleetExplorer.
    void Explore(const Heard &change, Duration now);
    RabitHandlerThread *Handlers() const { return _handlers.get(); }
    GatewayPath &PathOf(const std::string &node) { return *_paths[_choice.Of(node)]; }

    std::unique_ptr<AgreementDriver> MakeAgreement(const RandomSource &random);
    // Takes in what the beats of a path told of the agreement of others.
    void TakeAgreements(const Presence::Served &served);

    ConfigError NameTaken() const;
    // The beginning of each line of the log.
    static std::string LogNameOf(const GatewayConfig &config, const RabitWorkspace &workspace);

    // Nodes that the configuration names, and those for which messages wait, are not forgotten.
    bool IsNeeded(const std::string &node) const;
    void ReportUndelivered() const;
    void Log(const std::vector<std::string> &lines) const;
    void TellClocks() const;
    void PostFleet(Duration now);
    void ReportPublications(Gateway::Fleet &fleet) const;
    void ReportAir(Gateway::Fleet &fleet, Duration now);

    // Returns a report of this node, for one that requests it; empty: there is none, or it is refused.
    std::optional<std::string> ReportOf(NodeReports::Name name) const;
    void OnText(const std::string &node, std::uint64_t definition, TypeQuestions::Answer answer);
    void AddProblems(Duration now, Gateway::Fleet &fleet) const;

    const GatewayConfig &_config;  // the manager's
    GatewayManager &_manager;
    RabitWorkspace &_workspace;
    const bool _isStepped;
    IncarnationStore _incarnations;
    OriginTable _origins;
    RemoteQueues _remote;
    HandlerWatch _slow{_workspace.GetClock()};
    // Calls the program's own handlers of data from other nodes. Null where the network is stepped.
    const std::unique_ptr<RabitHandlerThread> _handlers{
        !_isStepped ? std::make_unique<RabitHandlerThread>(&_slow) : nullptr};
    LinkDriver _links;
    const std::shared_ptr<OutgoingQueues> _outgoing;
    const std::uint64_t _incarnation;
    const SourceClock _source;
    Subscriptions _subscriptions;
    PathChoice _choice;
    Duration _nextLook{0};
    ForeignTopics _foreign{_config, _source, Handlers()};
    std::shared_ptr<Gateway::Fleet> _fleet;
    LinkStrains _strains;
    FullQueues _fullQueues;
    Exploration &_exploration;
    std::optional<Duration> _exploredAt;
    const std::string _logName = LogNameOf(_config, _workspace);
    const std::string _fleetName = FleetMessageNameOf(_config);
    ProblemLog _problemLog{_fleetName};
    ProblemLog::Standing _lasted;
    ProblemTexts _problemTexts{_config.Tool.has_value()};  // of the others
    const OwnLog _log{_logName + "node " + _config.Node + ", " + Whereabouts::OfThisProcess()};
    bool _forwards = false;
    Duration _nextFleet{0};
    Duration _earliestFleet{0};
    Duration _openedAt{0};
    bool _isOpen = false;
    NodeMembers _members;
    std::optional<Claims> _claims;                // for the report; empty: no agreement
    std::unique_ptr<AgreementDriver> _agreement;  // null: the configuration has none
    std::vector<std::unique_ptr<GatewayPath>> _paths;
    std::optional<PeersOverPaths> _peers;
};

}  // namespace Rabit
