// Gazebo's own physics as a program: loads a world into the dartsim plugin of gz-physics 5 and steps it.
//
// dartsim PLUGIN WORLD.sdf reads from standard input, one order a line:
//   link MODEL LINK | joint MODEL JOINT       print it in every sample, in this order
//   servo MODEL JOINT SPEED                   velocity command of every step from now on [rad/s or m/s]
//   force MODEL JOINT FORCE                   force of every step from now on [N m or N]
//   kick MODEL VX VY VZ WX WY WZ              velocity of a free model [m/s, rad/s]
//   run STEPS EVERY STEP                      steps of STEP seconds, a sample after every EVERY steps
// A sample is one line: for a link x y z qw qx qy qz, for a joint position and velocity.
//
// Source: https://github.com/gazebosim/gz-physics/blob/ign-physics5/examples/hello_world_loader/hello_world_loader.cc
#include <chrono>
#include <cstdio>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <ignition/physics/ForwardStep.hh>
#include <ignition/physics/FrameSemantics.hh>
#include <ignition/physics/FreeGroup.hh>
#include <ignition/physics/GetEntities.hh>
#include <ignition/physics/Joint.hh>
#include <ignition/physics/RequestEngine.hh>
#include <ignition/physics/sdf/ConstructWorld.hh>
#include <ignition/plugin/Loader.hh>
#include <sdf/Root.hh>
#include <sdf/World.hh>

namespace physics = ignition::physics;

struct Features
    : physics::FeatureList<physics::ForwardStep, physics::sdf::ConstructSdfWorld, physics::GetEntities,
                           physics::LinkFrameSemantics, physics::GetBasicJointState, physics::SetBasicJointState,
                           physics::SetJointVelocityCommandFeature, physics::FindFreeGroupFeature,
                           physics::SetFreeGroupWorldVelocity> {};

using Joint = physics::Joint3dPtr<Features>;
using Link = physics::Link3dPtr<Features>;

int main(int count, char **arguments) {
  if (count != 3) {
    std::cerr << "usage: dartsim PLUGIN WORLD.sdf\n";
    return 2;
  }
  ignition::plugin::Loader loader;
  loader.LoadLib(arguments[1]);
  auto engine = physics::RequestEngine3d<Features>::From(loader.Instantiate("ignition::physics::dartsim::Plugin"));
  if (!engine) {
    std::cerr << "no engine\n";
    return 1;
  }
  sdf::Root root;
  for (const auto &error : root.Load(arguments[2])) std::cerr << error.Message() << '\n';
  if (root.WorldCount() != 1) return 1;
  auto world = engine->ConstructWorld(*root.WorldByIndex(0));

  struct Watched {
    Link link;
    Joint joint;
  };
  std::vector<Watched> watched;
  std::map<std::string, std::pair<Joint, double>> servos, forces;
  physics::ForwardStep::Input input;
  physics::ForwardStep::Output output;
  physics::ForwardStep::State state;

  std::string line;
  while (std::getline(std::cin, line)) {
    std::istringstream words(line);
    std::string order;
    words >> order;
    if (order == "run") {
      long steps, every;
      double step;
      words >> steps >> every >> step;
      input.Get<std::chrono::steady_clock::duration>() =
          std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(step));
      for (long number = 1; number <= steps; ++number) {
        for (auto &each : servos) each.second.first->SetVelocityCommand(0, each.second.second);
        for (auto &each : forces) each.second.first->SetForce(0, each.second.second);
        world->Step(output, state, input);
        if (number % every) continue;
        for (const auto &each : watched) {
          if (each.link) {
            const auto pose = each.link->FrameDataRelativeToWorld().pose;
            const Eigen::Quaterniond turn(pose.linear());
            std::printf("%.12g %.12g %.12g %.12g %.12g %.12g %.12g ", pose.translation().x(), pose.translation().y(),
                        pose.translation().z(), turn.w(), turn.x(), turn.y(), turn.z());
          } else {
            std::printf("%.12g %.12g ", each.joint->GetPosition(0), each.joint->GetVelocity(0));
          }
        }
        std::printf("\n");
      }
      continue;
    }
    std::string name, part;
    words >> name;
    auto model = world->GetModel(name);
    if (!model) {
      std::cerr << "no model " << name << '\n';
      return 1;
    }
    if (order == "kick") {
      Eigen::Vector3d linear, angular;
      words >> linear.x() >> linear.y() >> linear.z() >> angular.x() >> angular.y() >> angular.z();
      auto group = model->FindFreeGroup();
      group->SetWorldLinearVelocity(linear);
      group->SetWorldAngularVelocity(angular);
      continue;
    }
    words >> part;
    if (order == "link") {
      watched.push_back({model->GetLink(part), {}});
      if (!watched.back().link) return 1;
      continue;
    }
    auto joint = model->GetJoint(part);
    if (!joint) {
      std::cerr << "no joint " << part << '\n';
      return 1;
    }
    double value = 0.0;
    words >> value;
    if (order == "joint") watched.push_back({{}, joint});
    if (order == "servo") servos[name + "::" + part] = {joint, value};
    if (order == "force") forces[name + "::" + part] = {joint, value};
  }
  return 0;
}
