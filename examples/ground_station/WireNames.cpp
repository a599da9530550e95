#include "WireNames.h"

namespace Ground
{

const char *WireName(RowState state)
{
    switch (state)
    {
        case RowState::Waiting:
            return "waiting";
        case RowState::Up:
            return "up";
        case RowState::Stale:
            return "stale";
        case RowState::Lost:
            return "lost";
    }
    return "unknown";
}

const char *WireName(Uav::MissionMode mode)
{
    switch (mode)
    {
        case Uav::MissionMode::MISSION_IDLE:
            return "idle";
        case Uav::MissionMode::MISSION_TRANSIT:
            return "transit";
        case Uav::MissionMode::MISSION_SEARCH:
            return "search";
        case Uav::MissionMode::MISSION_CONFIRM:
            return "confirm";
        case Uav::MissionMode::MISSION_VALIDATE:
            return "validate";
        case Uav::MissionMode::MISSION_TRACK:
            return "track";
        case Uav::MissionMode::MISSION_GOTO:
            return "goto";
        case Uav::MissionMode::MISSION_HOLD:
            return "hold";
        case Uav::MissionMode::MISSION_HOME:
            return "home";
    }
    return "unknown";
}

const char *WireName(Uav::TargetStage stage)
{
    switch (stage)
    {
        case Uav::TargetStage::TARGET_FOUND:
            return "found";
        case Uav::TargetStage::TARGET_VALIDATING:
            return "validating";
        case Uav::TargetStage::TARGET_VALIDATED:
            return "validated";
        case Uav::TargetStage::TARGET_TRACKED:
            return "tracked";
        case Uav::TargetStage::TARGET_REJECTED:
            return "rejected";
    }
    return "unknown";
}

const char *WireName(OrderKind kind)
{
    switch (kind)
    {
        case OrderKind::ORDER_GOTO:
            return "goto";
        case OrderKind::ORDER_HOME:
            return "home";
        case OrderKind::ORDER_SEARCH:
            return "search";
    }
    return "unknown";
}

const char *WireName(CommandProgress progress)
{
    switch (progress)
    {
        case CommandProgress::PROGRESS_SENT:
            return "sent";
        case CommandProgress::PROGRESS_DELIVERED:
            return "delivered";
        case CommandProgress::PROGRESS_ACCEPTED:
            return "accepted";
        case CommandProgress::PROGRESS_DONE:
            return "done";
        case CommandProgress::PROGRESS_DECLINED:
            return "declined";
        case CommandProgress::PROGRESS_REPLACED:
            return "replaced";
        case CommandProgress::PROGRESS_EXPIRED:
            return "expired";
        case CommandProgress::PROGRESS_IN_DOUBT:
            return "in doubt";
        case CommandProgress::PROGRESS_REFUSED:
            return "refused";
    }
    return "unknown";
}

}  // namespace Ground
