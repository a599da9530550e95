#include "World.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <initializer_list>
#include <numbers>
#include <sstream>

namespace Swarm
{
namespace
{
constexpr std::size_t MaxTargets = 1000;
constexpr double RadPerDeg = std::numbers::pi / 180;

// Reads one file; errors have their position.
class WorldReader
{
public:
    explicit WorldReader(std::string name) : _name(std::move(name)) {}

    World Read(const YAML::Node &root) const
    {
        CheckKeys(root, "the file", {"ground_m", "targets"});
        World world;
        world.GroundM = Number(root, "ground_m", -500, 9000);
        const YAML::Node targets = root["targets"];
        if (!targets || !targets.IsSequence())
            Fail(targets ? targets.Mark() : root.Mark(), "targets is not a list");
        if (targets.size() > MaxTargets)
            Fail(targets.Mark(), "more than " + std::to_string(MaxTargets) + " targets");
        for (const YAML::Node &target : targets)
            world.Targets.push_back(Target(target, world.GroundM));
        return world;
    }
    [[noreturn]] void Fail(const YAML::Mark &mark, const std::string &problem) const
    {
        throw WorldError(_name + ":" + std::to_string(std::max(mark.line, 0) + 1) + ": " + problem);
    }

private:
    WorldTarget Target(const YAML::Node &node, double groundM) const
    {
        CheckKeys(node, "a target", {"latitude_deg", "longitude_deg", "walk"});
        WorldTarget target;
        target.Start = {Number(node, "latitude_deg", -90, 90), Number(node, "longitude_deg", -180, 180),
                        groundM};
        if (const YAML::Node walk = node["walk"])
        {
            CheckKeys(walk, "walk", {"speed_mps", "heading_deg", "length_m"});
            target.SpeedMps = Number(walk, "speed_mps", 0.01, 100);
            target.HeadingRad = Number(walk, "heading_deg", -360, 360) * RadPerDeg;
            target.LengthM = Number(walk, "length_m", 1, 100000);
        }
        return target;
    }
    void CheckKeys(const YAML::Node &node, const std::string &what,
                   std::initializer_list<std::string> known) const
    {
        if (!node.IsMap())
            Fail(node.Mark(), what + " is not a map");
        for (const auto &entry : node)
        {
            const auto key = entry.first.as<std::string>("");
            if (std::find(known.begin(), known.end(), key) == known.end())
                Fail(entry.first.Mark(), "unknown key `" + key + "`");
        }
    }
    double Number(const YAML::Node &map, const std::string &key, double min, double max) const
    {
        const YAML::Node node = map[key];
        if (!node)
            Fail(map.Mark(), key + " is missing");
        double value = 0;
        if (!YAML::convert<double>::decode(node, value) || !(value >= min && value <= max))
        {
            std::ostringstream problem;
            problem << key << " is not a number from " << min << " to " << max;
            Fail(node.Mark(), problem.str());
        }
        return value;
    }

    const std::string _name;
};
}  // namespace

GeoPoint WorldTarget::At(double gpsTimeS) const
{
    if (SpeedMps <= 0 || LengthM <= 0)
        return Start;
    const double way = std::fmod(SpeedMps * gpsTimeS, 2 * LengthM);
    const double gone = way <= LengthM ? way : 2 * LengthM - way;
    return Moved(Start, {gone * std::cos(HeadingRad), gone * std::sin(HeadingRad), 0});
}

World World::Load(const std::string &file)
{
    std::ifstream stream(file);
    std::ostringstream text;
    text << stream.rdbuf();
    if (!stream || !text)
        throw WorldError(file + ": cannot be read");
    return Parse(text.str(), file);
}

World World::Parse(const std::string &text, const std::string &name)
{
    const WorldReader reader(name);
    try
    {
        return reader.Read(YAML::Load(text));
    }
    catch (const YAML::Exception &error)
    {
        reader.Fail(error.mark, error.msg);
    }
}

}  // namespace Swarm
