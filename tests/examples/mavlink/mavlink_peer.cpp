// Exchanges our MAVLink with another implementation, as text.
//
//   mavlink_peer < hexadecimal   prints the frames in the bytes, a line for each
//   mavlink_peer --send          prints one frame of each type and version, in hexadecimal
#include <mavlink/MavlinkFrame.h>
#include <mavlink/MavlinkMessages.h>

#include <cstdint>
#include <iomanip>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace
{

using namespace Swarm;

void Print(const MavlinkFrame &frame)
{
    std::cout << (frame.Protocol == MavlinkFrame::Version::One ? "v1" : "v2") << ' ' << int{frame.Sequence}
              << ' ' << int{frame.System} << ' ' << int{frame.Component} << std::setprecision(9);
    if (const auto m = MavlinkHeartbeat::Decode(frame))
    {
        std::cout << " HEARTBEAT " << m->CustomMode << ' ' << int{m->Type} << ' ' << int{m->Autopilot} << ' '
                  << int{m->BaseMode} << ' ' << int{m->SystemStatus} << ' ' << int{m->ProtocolVersion};
    }
    else if (const auto a = MavlinkAttitude::Decode(frame))
    {
        std::cout << " ATTITUDE " << a->TimeSinceBootMs << ' ' << a->Roll << ' ' << a->Pitch << ' ' << a->Yaw
                  << ' ' << a->RollSpeed << ' ' << a->PitchSpeed << ' ' << a->YawSpeed;
    }
    else if (const auto p = MavlinkGlobalPosition::Decode(frame))
    {
        std::cout << " GLOBAL_POSITION_INT " << p->TimeSinceBootMs << ' ' << p->LatitudeE7 << ' '
                  << p->LongitudeE7 << ' ' << p->AltitudeMm << ' ' << p->RelativeAltitudeMm << ' '
                  << p->NorthCmps << ' ' << p->EastCmps << ' ' << p->DownCmps << ' ' << p->HeadingCdeg;
    }
    else if (const auto t = MavlinkPositionTarget::Decode(frame))
    {
        std::cout << " SET_POSITION_TARGET_GLOBAL_INT " << t->TimeSinceBootMs << ' ' << int{t->TargetSystem}
                  << ' ' << int{t->TargetComponent} << ' ' << int{t->CoordinateFrame} << ' ' << t->TypeMask
                  << ' ' << t->LatitudeE7 << ' ' << t->LongitudeE7 << ' ' << t->AltitudeM << ' '
                  << t->VelocityNorth << ' ' << t->VelocityEast << ' ' << t->VelocityDown << ' '
                  << t->AccelerationNorth << ' ' << t->AccelerationEast << ' ' << t->AccelerationDown << ' '
                  << t->Yaw << ' ' << t->YawRate;
    }
    std::cout << '\n';
}

int Receive()
{
    MavlinkParser parser;
    for (std::string pair; std::cin >> std::setw(2) >> pair;)
    {
        const auto byte = static_cast<std::uint8_t>(std::stoul(pair, nullptr, 16));
        parser.Add({&byte, 1});
        while (const auto frame = parser.Next())
        {
            Print(*frame);
        }
    }
    return 0;
}

void Send(MavlinkFrame frame)
{
    for (const auto version : {MavlinkFrame::Version::One, MavlinkFrame::Version::Two})
    {
        frame.Protocol = version;
        frame.Sequence = 200;
        frame.System = 12;
        frame.Component = 34;
        for (const std::uint8_t byte : EncodeMavlink(frame))
        {
            std::cout << std::hex << std::setw(2) << std::setfill('0') << int{byte};
        }
        std::cout << '\n';
    }
}

}  // namespace

int main(int argc, char **argv)
{
    if (argc < 2 || std::string(argv[1]) != "--send")
    {
        return Receive();
    }
    Send(MavlinkHeartbeat{.CustomMode = 7, .Type = 18, .Autopilot = 8, .BaseMode = 128, .SystemStatus = 4}
             .Encode());
    Send(MavlinkAttitude{.TimeSinceBootMs = 1, .Roll = -0.5f, .Pitch = 0.25f, .Yaw = 3.0f}.Encode());
    Send(MavlinkGlobalPosition{.TimeSinceBootMs = 2,
                               .LatitudeE7 = -337'500'000,
                               .LongitudeE7 = 1'512'500'000,
                               .AltitudeMm = 520'000,
                               .RelativeAltitudeMm = 20'000,
                               .NorthCmps = -800,
                               .EastCmps = 801,
                               .DownCmps = -1,
                               .HeadingCdeg = 27'000}
             .Encode());
    Send(MavlinkPositionTarget{
        .TimeSinceBootMs = 3, .LatitudeE7 = 473'977'000, .LongitudeE7 = -85'456'000, .AltitudeM = 520.5f}
             .Encode());
}
