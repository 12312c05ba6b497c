use anyhow::bail;
use sunfleck::document::{Map, Scene, Sensor, System, unknown_name};

/// Scene that is run, with one sensor for each sensor and system.
#[derive(Debug)]
pub(crate) struct Plan {
    /// The scene.
    pub(crate) scene: Scene,
    /// Whose sensor and system its sensors are, in its order.
    pub(crate) members: Vec<Member>,
    /// Notes for the user.
    pub(crate) warnings: Vec<String>,
}

/// A sensor measured by a system.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    pub(crate) sensor: String,
    pub(crate) system: System,
}

impl Plan {
    /// All sensors of a scene, or those named, by all systems that can.
    ///
    /// # Errors
    /// If a named sensor does not exist, or no system can measure any.
    pub(crate) fn new(scene: &Scene, named: &[String], systems: &[System]) -> anyhow::Result<Self> {
        if let Some(unknown) = named.iter().find(|name| !scene.sensors.contains_key(*name)) {
            let known = scene.sensors.keys().map(String::as_str);
            let problem = unknown_name("--sensor", "sensor", unknown, known);
            bail!("{}; {}", problem.message, problem.help.unwrap_or_default());
        }
        let mut sensors: Map<Sensor> = Map::new();
        let (mut members, mut warnings) = (Vec::new(), Vec::new());
        let asked = |name: &String| named.is_empty() || named.contains(name);
        for (name, sensor) in scene.sensors.iter().filter(|(name, _)| asked(name)) {
            let before = members.len();
            for &system in systems {
                let Some(copy) = sensor.measured_by(system, scene) else {
                    if system == System::FirstOrder && sensor.systems().contains(&system) {
                        warnings.push(format!(
                            "sensors.{name}: first_order measures `Orders`; add it to `measure` to compare it"
                        ));
                    }
                    continue;
                };
                // Streams have the sensor's name as their key: those of two systems are independent.
                sensors.insert(format!("{name} [{}]", system.name()), copy);
                members.push(Member { sensor: name.clone(), system });
            }
            if members.len() == before {
                let can = |&system: &System| sensor.measured_by(system, scene).is_some();
                let able: Vec<System> = System::ALL.into_iter().filter(can).collect();
                warnings.push(format!(
                    "sensors.{name}: none of {} can measure it; {} can",
                    names(systems),
                    names(&able)
                ));
            }
        }
        if members.is_empty() {
            bail!("{}", warnings.join("\n"));
        }
        Ok(Self { scene: Scene { sensors, ..scene.clone() }, members, warnings })
    }

    /// The scene with other random streams for all sensors, the same for the same number.
    pub(crate) fn again(&self, number: usize) -> Scene {
        let sensors = self.scene.sensors.iter();
        let sensors = sensors.map(|(name, sensor)| (format!("{name} {number}"), sensor.clone()));
        Scene { sensors: sensors.collect(), ..self.scene.clone() }
    }
}

/// `backward, forward`.
pub(crate) fn names(systems: &[System]) -> String {
    systems.iter().map(|system| system.name()).collect::<Vec<_>>().join(", ")
}
