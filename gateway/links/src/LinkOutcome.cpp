#include <rabit/gateway/links/LinkOutcome.h>

namespace Rabit
{

std::string_view ToString(LinkOutcome outcome)
{
    switch (outcome)
    {
        case LinkOutcome::Delivered:
            return "delivered";
        case LinkOutcome::Expired:
            return "expired";
        case LinkOutcome::InDoubt:
            return "in doubt";
        case LinkOutcome::RefusedThere:
            return "refused there";
    }
    return "unknown outcome";
}

std::string_view ToString(LinkRefusal refusal)
{
    switch (refusal)
    {
        case LinkRefusal::None:
            return "accepted";
        case LinkRefusal::FullByCount:
            return "outbox full by count";
        case LinkRefusal::FullByBytes:
            return "outbox full by bytes";
        case LinkRefusal::TooLarge:
            return "larger than the outbox";
        case LinkRefusal::BadName:
            return "impossible destination, queue or type name";
        case LinkRefusal::TooManyPeers:
            return "too many peers";
        case LinkRefusal::TooManyLinks:
            return "too many links to this destination";
    }
    return "unknown refusal";
}

}  // namespace Rabit
