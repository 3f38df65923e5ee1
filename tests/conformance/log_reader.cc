// Prints what Gazebo's own log library finds in a log.
#include <iostream>
#include <ignition/transport/log/Batch.hh>
#include <ignition/transport/log/Log.hh>
#include <ignition/transport/log/Message.hh>
int main(int, char **arguments) {
  ignition::transport::log::Log log;
  if (!log.Open(arguments[1], std::ios_base::in)) return 1;
  std::cout << log.Version() << ' ' << log.StartTime().count() << ' ' << log.EndTime().count() << '\n';
  for (const auto &each : log.QueryMessages())
    std::cout << each.TimeReceived().count() << ' ' << each.Topic() << ' ' << each.Type() << ' ' << each.Data() << '\n';
}
