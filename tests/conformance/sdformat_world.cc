// Prints where libsdformat puts everything in a world: for every path read from standard input one line of JSON, a list
// of [kind, scoped name, x, y, z, qw, qx, qy, qz] in the world frame (for axes x, y, z only), or the errors. Built by
// test_worlds.py.
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include <sdf/sdf.hh>

using ignition::math::Pose3d;
using ignition::math::Vector3d;

static std::ostringstream out;
static std::string separator;
static std::string failures;

static void add(const std::string &_kind, const std::string &_name, const Pose3d &_pose)
{
  out << separator << "[\"" << _kind << "\",\"" << _name << "\"";
  for (double value : {_pose.Pos().X(), _pose.Pos().Y(), _pose.Pos().Z(), _pose.Rot().W(), _pose.Rot().X(),
       _pose.Rot().Y(), _pose.Rot().Z()})
    out << "," << std::setprecision(17) << value;
  out << "]";
  separator = ",";
}

template <typename T> static Pose3d within(const Pose3d &_model, const T &_thing, const std::string &_to)
{
  Pose3d found;
  for (const auto &error : _thing.SemanticPose().Resolve(found, _to))
    failures += error.Message() + " | ";
  return _model * found;
}

static void model(const sdf::Model &_model, const Pose3d &_parent, const std::string &_scope, const std::string &_to)
{
  const Pose3d place = within(_parent, _model, _to);
  const std::string name = _scope + _model.Name();
  add("model", name, place);
  for (uint64_t i = 0; i < _model.LinkCount(); ++i)
  {
    const sdf::Link &link = *_model.LinkByIndex(i);
    add("link", name + "::" + link.Name(), within(place, link, "__model__"));
    for (uint64_t j = 0; j < link.CollisionCount(); ++j)
    {
      const sdf::Collision &part = *link.CollisionByIndex(j);
      add("collision", name + "::" + link.Name() + "::" + part.Name(), within(place, part, "__model__"));
    }
  }
  for (uint64_t i = 0; i < _model.JointCount(); ++i)
  {
    const sdf::Joint &joint = *_model.JointByIndex(i);
    add("joint", name + "::" + joint.Name(), within(place, joint, "__model__"));
    std::string child, parent;
    joint.ResolveChildLink(child);
    joint.ResolveParentLink(parent);
    add("child", name + "::" + joint.Name() + "=" + child, Pose3d::Zero);
    add("parent", name + "::" + joint.Name() + "=" + parent, Pose3d::Zero);
    for (unsigned int number : {0u, 1u})
    {
      const sdf::JointAxis *axis = joint.Axis(number);
      if (!axis)
        continue;
      Vector3d xyz;
      for (const auto &error : axis->ResolveXyz(xyz, "__model__"))
        failures += error.Message() + " | ";
      add("axis" + std::to_string(number), name + "::" + joint.Name(),
          Pose3d(place.Rot().RotateVector(xyz), ignition::math::Quaterniond::Identity));
    }
  }
  for (uint64_t i = 0; i < _model.ModelCount(); ++i)
    model(*_model.ModelByIndex(i), place, name + "::", "__model__");
}

int main()
{
  sdf::Console::Instance()->SetQuiet(true);
  sdf::setFindCallback([](const std::string &_uri) { return _uri; });
  std::string path;
  while (std::getline(std::cin, path))
  {
    sdf::Root root;
    failures.clear();
    out.str("");
    separator.clear();
    for (const auto &error : root.Load(path))
      failures += error.Message() + " | ";
    const sdf::World *world = root.WorldByIndex(0);
    for (uint64_t i = 0; world && i < world->ModelCount(); ++i)
      model(*world->ModelByIndex(i), Pose3d::Zero, "", "world");
    for (uint64_t i = 0; world && i < world->LightCount(); ++i)
      add("light", world->LightByIndex(i)->Name(), within(Pose3d::Zero, *world->LightByIndex(i), "world"));
    std::string text;
    for (char c : failures)
      text += c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    std::cout << "{\"errors\":\"" << text << "\",\"found\":[" << out.str() << "]}" << std::endl;
  }
  return 0;
}
