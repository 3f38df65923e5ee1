// Prints what libsdformat makes of SDF and URDF files: for every path read from standard input one line of JSON with the
// links, joints, shapes, sensors and frames of its model, all poses in the model's frame. Built by test_urdf.py.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>

#include <sdf/sdf.hh>

static std::string quoted(const std::string &_text)
{
  std::ostringstream out;
  out << '"';
  for (char c : _text)
  {
    if (c == '"' || c == '\\')
      out << '\\' << c;
    else if (static_cast<unsigned char>(c) < 0x20)
      out << ' ';
    else
      out << c;
  }
  out << '"';
  return out.str();
}

static std::string number(double _value)
{
  if (std::isnan(_value) || std::isinf(_value))
    return _value > 0 ? "1e308" : "-1e308";
  std::ostringstream out;
  out << std::setprecision(17) << _value;
  return out.str();
}

static std::string list(const std::vector<double> &_values)
{
  std::string text = "[";
  for (double value : _values)
    text += (text.size() > 1 ? "," : "") + number(value);
  return text + "]";
}

template <typename T> static std::string pose(const T &_thing)
{
  ignition::math::Pose3d found;
  sdf::Errors errors = _thing.SemanticPose().Resolve(found, "__model__");
  if (!errors.empty())
    return "null";
  return list({found.Pos().X(), found.Pos().Y(), found.Pos().Z(), found.Rot().W(), found.Rot().X(), found.Rot().Y(),
      found.Rot().Z()});
}

static std::string size(const sdf::Geometry *_geometry)
{
  if (!_geometry)
    return "null";
  if (_geometry->BoxShape())
  {
    auto s = _geometry->BoxShape()->Size();
    return list({s.X(), s.Y(), s.Z()});
  }
  if (_geometry->CylinderShape())
    return list({_geometry->CylinderShape()->Radius(), _geometry->CylinderShape()->Length()});
  if (_geometry->SphereShape())
    return list({_geometry->SphereShape()->Radius()});
  return "null";
}

static std::string model(const sdf::Model &_model)
{
  std::ostringstream out;
  out << "{\"name\":" << quoted(_model.Name()) << ",\"static\":" << (_model.Static() ? "true" : "false");
  out << ",\"links\":[";
  for (uint64_t i = 0; i < _model.LinkCount(); ++i)
  {
    const sdf::Link &link = *_model.LinkByIndex(i);
    auto inertial = link.Inertial();
    auto com = inertial.Pose().Pos();
    auto moi = inertial.Moi();
    out << (i ? "," : "") << "{\"name\":" << quoted(link.Name()) << ",\"pose\":" << pose(link) << ",\"mass\":"
        << number(inertial.MassMatrix().Mass()) << ",\"com\":" << list({com.X(), com.Y(), com.Z()}) << ",\"inertia\":"
        << list({moi(0, 0), moi(1, 1), moi(2, 2), moi(0, 1), moi(0, 2), moi(1, 2)}) << ",\"collisions\":[";
    for (uint64_t j = 0; j < link.CollisionCount(); ++j)
    {
      const sdf::Collision &part = *link.CollisionByIndex(j);
      double mu = 1.0;
      if (part.Element()->HasElement("surface"))
      {
        auto surface = part.Element()->GetElement("surface");
        if (surface->HasElement("friction") && surface->GetElement("friction")->HasElement("ode"))
          mu = surface->GetElement("friction")->GetElement("ode")->Get<double>("mu");
      }
      out << (j ? "," : "") << "{\"name\":" << quoted(part.Name()) << ",\"pose\":" << pose(part) << ",\"size\":"
          << size(part.Geom()) << ",\"mu\":" << number(mu) << "}";
    }
    out << "],\"visuals\":[";
    for (uint64_t j = 0; j < link.VisualCount(); ++j)
    {
      const sdf::Visual &part = *link.VisualByIndex(j);
      std::string colour = "null", script;
      if (part.Material())
      {
        auto c = part.Material()->Diffuse();
        colour = list({c.R(), c.G(), c.B(), c.A()});
        script = part.Material()->ScriptName();
      }
      out << (j ? "," : "") << "{\"name\":" << quoted(part.Name()) << ",\"pose\":" << pose(part) << ",\"size\":"
          << size(part.Geom()) << ",\"diffuse\":" << colour << ",\"script\":" << quoted(script) << "}";
    }
    out << "],\"sensors\":[";
    for (uint64_t j = 0; j < link.SensorCount(); ++j)
    {
      const sdf::Sensor &part = *link.SensorByIndex(j);
      out << (j ? "," : "") << "{\"name\":" << quoted(part.Name()) << ",\"pose\":" << pose(part) << "}";
    }
    out << "]}";
  }
  out << "],\"joints\":[";
  for (uint64_t i = 0; i < _model.JointCount(); ++i)
  {
    const sdf::Joint &joint = *_model.JointByIndex(i);
    out << (i ? "," : "") << "{\"name\":" << quoted(joint.Name()) << ",\"type\":" << static_cast<int>(joint.Type())
        << ",\"parent\":" << quoted(joint.ParentLinkName()) << ",\"child\":" << quoted(joint.ChildLinkName())
        << ",\"pose\":" << pose(joint) << ",\"axis\":";
    const sdf::JointAxis *axis = joint.Axis();
    if (axis)
    {
      ignition::math::Vector3d xyz;
      axis->ResolveXyz(xyz, "__model__");
      out << list({xyz.X(), xyz.Y(), xyz.Z(), axis->Lower(), axis->Upper(), axis->Effort(), axis->MaxVelocity(),
          axis->Damping(), axis->Friction(), axis->SpringStiffness(), axis->SpringReference()});
    }
    else
      out << "null";
    out << "}";
  }
  out << "],\"frames\":[";
  for (uint64_t i = 0; i < _model.FrameCount(); ++i)
  {
    const sdf::Frame &frame = *_model.FrameByIndex(i);
    out << (i ? "," : "") << "{\"name\":" << quoted(frame.Name()) << ",\"pose\":" << pose(frame) << "}";
  }
  out << "]}";
  return out.str();
}

int main()
{
  sdf::Console::Instance()->SetQuiet(true);
  std::string path;
  while (std::getline(std::cin, path))
  {
    sdf::Root root;
    sdf::Errors errors = root.Load(path);
    std::string text;
    for (const auto &error : errors)
      text += error.Message() + " | ";
    std::cout << "{\"errors\":" << quoted(text) << ",\"model\":" << (root.Model() ? model(*root.Model()) : "null") << "}"
              << std::endl;
  }
  return 0;
}
