#include "sim/scene_builder.hpp"

#include "sim/robot_builder.hpp"
#include "sim/terrain_builder.hpp"
#include "sim/xml_element.hpp"

namespace hopscotch::sim {

std::string scene_mjcf(const model::RobotParameters& robot, const Terrain& terrain) {
  constexpr double kRobotFriction = 1.0;  // never counts: the terrain's geoms have priority
  const RobotXml robot_pieces = robot_xml(robot, kRobotFriction);
  const TerrainXml terrain_pieces = terrain_xml(terrain);
  return XmlElement("mujoco")
      .with("model", "hopscotch")
      .containing(simulation_settings())
      .containing(
          XmlElement("asset").containing(terrain_pieces.assets + robot_pieces.assets).text())
      .containing(
          XmlElement("worldbody").containing(terrain_pieces.world + robot_pieces.body).text())
      .containing(XmlElement("actuator").containing(robot_pieces.actuators).text())
      .containing(XmlElement("sensor").containing(robot_pieces.sensors).text())
      .text();
}

}  // namespace hopscotch::sim
