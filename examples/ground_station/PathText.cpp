#include "PathText.h"

#include "NumberText.h"
#include "WrappedLines.h"

#include <algorithm>
#include <cmath>

namespace Ground
{
namespace
{
constexpr std::size_t LongestNode = 24;
constexpr std::size_t ColumnWidth = PathColumnsWidth / 2;

std::string Column(const std::string &text)
{
    return std::string(ColumnWidth - std::min(ColumnWidth, text.size()), ' ') + text;
}

bool IsRoundTripKnown(const FleetRow &row)
{
    return std::isfinite(row.RoundTripS) && row.RoundTripS >= 0;
}

bool IsDeliveryKnown(const FleetRow &row)
{
    return std::isfinite(row.DeliveryRate) && row.DeliveryRate > 0;
}

std::string DeliveryText(const FleetRow &row)
{
    return IsDeliveryKnown(row) ? KiloText(row.DeliveryRate) : "-";
}

bool IsOld(const FleetRow &row)
{
    return row.State != RowState::Up && (IsRoundTripKnown(row) || IsDeliveryKnown(row));
}

std::string ListText(const FleetRow &row)
{
    std::string text = IsRoundTripKnown(row) ? MillisecondsText(row.RoundTripS) + " ms" : "";
    if (IsDeliveryKnown(row))
        text.append(text.empty() ? "" : " ").append(BytesPerSecondText(row.DeliveryRate));
    const bool old = IsOld(row);
    return Printable(row.Node, LongestNode) + (old ? " (" : " ") + text + (old ? ")" : "");
}
}  // namespace

std::string PathHeading()
{
    return Column("RTT ms") + " " + Column("kB/s");
}

std::string PathColumns(const FleetRow &row)
{
    const bool old = IsOld(row);
    std::string roundTrip = old ? "(" : "";
    roundTrip += MillisecondsText(row.RoundTripS);
    return Column(roundTrip) + " " + Column(DeliveryText(row) + (old ? ")" : ""));
}

std::vector<std::string> PathLines(const std::vector<FleetRow> &rows, std::size_t columns)
{
    std::vector<std::string> parts;
    for (const FleetRow &row : rows)
        if (IsRoundTripKnown(row) || IsDeliveryKnown(row))
            parts.push_back(ListText(row));
    return WrappedLines("Round trips:", parts, columns);
}

std::string PathLogText(const FleetRow &row)
{
    std::string text = IsOld(row) ? "OLD " : "";
    if (IsRoundTripKnown(row))
        text.append("round trip ").append(MillisecondsText(row.RoundTripS)).append(" ms");
    if (IsDeliveryKnown(row))
        text.append(IsRoundTripKnown(row) ? ", delivers " : "delivers ")
            .append(BytesPerSecondText(row.DeliveryRate));
    return text;
}

}  // namespace Ground
