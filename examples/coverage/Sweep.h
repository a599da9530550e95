// The manager of an aircraft that covers an area together with others.
#pragma once

#include <rabit/RabitManager.h>
#include <rabit/gateway/Claims.h>
#include <rabit/gateway/SharedTable.h>

#include <cstddef>
#include <numeric>
#include <optional>
#include <set>
#include <string>

namespace Coverage
{

struct Settings
{
    int Cells = 24;             // 1 to 63: a claim each, and the lead
    double SecondsPerCell = 6;  // that an aircraft flies over a cell
};

// Flies one cell after the other, 5 times a second: each cell is flown by one aircraft. The leader calls all
// home once every cell is flown.
class Sweep : public Rabit::RabitManager
{
public:
    Sweep(const Settings &settings, Rabit::GatewayConfig &config, Rabit::RabitWorkspace &workspace)
        : RabitManager("Sweep", workspace),
          _settings(settings),
          _claims(config),
          _table(config),
          // Aircraft begin in different parts of the area, so they seldom want the same cell.
          _cell(static_cast<std::size_t>(std::accumulate(config.Node.begin(), config.Node.end(), 0)) * 5)
    {
        SetPeriodSec(0.2);
        _claims.BeLeader();
    }

    void ExecuteUnitOfWork() final
    {
        const std::set<std::size_t> flown = _table.Numbers("flown");
        if (_claims.IsLeader() && flown.size() >= Cells())
        {
            _table.Write("order", "home");  // writes once: the value stays the same
        }
        if (_table.Text("order") == "home")
        {
            FlyHome();
        }
        else if (_claims.StillMine(_claim))
        {
            Fly();
        }
        else if (!_claims.StatusOf(_claim).IsWanted)
        {
            Choose(flown);  // none yet, refused, or lost
        }
    }

    // The cell over which this aircraft flies now; empty: none.
    std::optional<std::size_t> Over() const
    {
        const bool flies = !_isHome && _claims.StillMine(_claim);
        return flies ? std::optional(_cell) : std::nullopt;
    }
    bool IsHome() const { return _isHome; }
    std::set<std::size_t> Flown() const { return _table.Numbers("flown"); }

private:
    std::size_t Cells() const { return static_cast<std::size_t>(_settings.Cells); }

    void Fly()
    {
        _flownS += GetPeriodSec();
        if (_flownS >= _settings.SecondsPerCell)
        {
            // The claim is kept: the others may not have heard yet that the cell is flown.
            _table.Add("flown", _cell);
            WriteLog(Rabit::RabitLogLevel::Info, _claim + " is flown");
            Choose(_table.Numbers("flown"));
        }
    }

    void Choose(const std::set<std::size_t> &flown)
    {
        _claim.clear();
        _flownS = 0;
        for (std::size_t i = 1; i <= Cells(); ++i)
        {
            const std::size_t cell = (_cell + i) % Cells();
            const std::string claim = "cell " + std::to_string(cell);
            if (!flown.contains(cell) && _claims.StatusOf(claim).Holder.empty())
            {
                _cell = cell;
                _claim = claim;
                _claims.Try(claim);
                return;
            }
        }
    }

    void FlyHome()
    {
        if (!_isHome)
        {
            _isHome = true;
            WriteLog(Rabit::RabitLogLevel::Info, "all " + std::to_string(Cells()) +
                                                     " cells are flown: " + _claims.Leader() + " calls home");
        }
    }

    const Settings _settings;
    Rabit::Claims _claims;
    Rabit::SharedTable _table;
    std::size_t _cell;   // where this aircraft is
    std::string _claim;  // of that cell; empty: none
    double _flownS = 0;
    bool _isHome = false;
};

}  // namespace Coverage
