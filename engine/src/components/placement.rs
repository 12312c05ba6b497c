use glam::{DMat3, DVec3};
use hecs::{BatchWriter, ColumnBatch, ColumnBatchBuilder, ColumnBatchType, Component, World};

use super::{PlantingId, PrototypeId, SceneId};

/// Position of the origin of an instance's prototype, m, local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Position(pub DVec3);

/// Right-handed turn of an instance about the vertical (counter-clockwise seen from above), rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Yaw(pub f32);

/// Lean of an instance from the vertical, applied after its yaw. Upright instances have none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lean {
    /// Angle from the vertical, rad.
    pub tilt: f32,
    /// Azimuth towards which the instance leans, clockwise from north, rad.
    pub azimuth: f32,
}

/// Scale of an instance, applied before its yaw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// Horizontal scale.
    pub horizontal: f32,
    /// Vertical scale.
    pub vertical: f32,
}

/// Placement of a mesh prototype.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement {
    /// Mesh prototype.
    pub prototype: PrototypeId,
    /// Position of the prototype's origin, m, local frame.
    pub position: DVec3,
    /// Turn about the vertical, rad.
    pub yaw: f32,
    /// Scale.
    pub scale: Scale,
    /// Lean after the turn.
    pub lean: Lean,
}

/// Components of an instance, by reference, as queries take them. Upright instances have no [`Lean`].
pub type InstanceQuery<'a> = (
    &'a SceneId,
    &'a PlantingId,
    &'a PrototypeId,
    &'a Position,
    &'a Yaw,
    &'a Scale,
    Option<&'a Lean>,
);

/// Components of an instance as one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instance {
    /// Place in document order over all instances.
    pub id: SceneId,
    /// Planting that it belongs to.
    pub planting: PlantingId,
    /// Placement of its prototype.
    pub placement: Placement,
}

/// Components of an upright instance.
type Upright = (SceneId, PlantingId, PrototypeId, Position, Yaw, Scale);

impl Instance {
    /// Instance whose components a query found.
    #[must_use]
    pub fn from_components(components: InstanceQuery<'_>) -> Self {
        let (&id, &planting, &prototype, &Position(position), &Yaw(yaw), &scale, lean) = components;
        let lean = lean.copied().unwrap_or(Lean::UPRIGHT);
        Self { id, planting, placement: Placement { prototype, position, yaw, scale, lean } }
    }

    /// All instances in document order.
    #[must_use]
    pub fn in_order(world: &World) -> Vec<Self> {
        let mut query = world.query::<InstanceQuery<'_>>();
        let mut instances: Vec<Self> = query.iter().map(Self::from_components).collect();
        instances.sort_unstable_by_key(|instance| instance.id);
        instances
    }

    /// Spawns all instances, upright and leaning ones apart.
    pub fn spawn<I: Iterator<Item = Self>>(instances: impl Fn() -> I, world: &mut World) {
        let leans = |instance: &Self| instance.placement.lean.tilt != 0.0;
        let (all, leaning) = (instances().count(), instances().filter(leans).count());
        // Columns of exactly this length become those of the world, without a copy.
        if leaning < all {
            let upright = instances().filter(|one| !leans(one));
            world.spawn_column_batch(columns(upright, all - leaning, false));
        }
        if leaning > 0 {
            world.spawn_column_batch(columns(instances().filter(leans), leaning, true));
        }
    }
}

/// Columns of the components of `count` instances.
fn columns(instances: impl Iterator<Item = Instance>, count: usize, lean: bool) -> ColumnBatch {
    let mut types = ColumnBatchType::new();
    types.add_bundle::<Upright>();
    if lean {
        types.add::<Lean>();
    }
    let batch = types.into_batch(count as u32);
    {
        let mut ids = column::<SceneId>(&batch);
        let mut plantings = column::<PlantingId>(&batch);
        let mut prototypes = column::<PrototypeId>(&batch);
        let mut positions = column::<Position>(&batch);
        let mut yaws = column::<Yaw>(&batch);
        let mut scales = column::<Scale>(&batch);
        let mut leans = batch.writer::<Lean>();
        for Instance { id, planting, placement } in instances {
            let Placement { prototype, position, yaw, scale, lean } = placement;
            push(&mut ids, id);
            push(&mut plantings, planting);
            push(&mut prototypes, prototype);
            push(&mut positions, Position(position));
            push(&mut yaws, Yaw(yaw));
            push(&mut scales, scale);
            if let Some(leans) = &mut leans {
                push(leans, lean);
            }
        }
    }
    batch.build().expect("each column holds all instances")
}

fn column<T: Component>(batch: &ColumnBatchBuilder) -> BatchWriter<'_, T> {
    batch.writer().expect("instances have this component")
}

fn push<T: Component>(column: &mut BatchWriter<'_, T>, value: T) {
    assert!(column.push(value).is_ok(), "there are no more instances than were counted");
}

impl Lean {
    /// No lean.
    pub const UPRIGHT: Self = Self { tilt: 0.0, azimuth: 0.0 };
}

impl Scale {
    /// Ratio of the sizes of the vertical scale and the horizontal one.
    #[must_use]
    pub fn ratio(self) -> f64 {
        (f64::from(self.vertical) / f64::from(self.horizontal)).abs()
    }
}

impl Placement {
    /// Factor by which the scales enlarge areas. It is exact if both are equal; leaves of all directions grow by
    /// nearly this factor if they differ.
    #[must_use]
    pub fn area_factor(&self) -> f64 {
        let (across, up) = (f64::from(self.scale.horizontal), f64::from(self.scale.vertical));
        (across * across * up).abs().powf(2.0 / 3.0)
    }

    /// Linear part of `world_from_object`: scale, then turn, then lean.
    #[must_use]
    pub fn world_from_object(&self) -> DMat3 {
        let scale = DVec3::new(
            self.scale.horizontal.into(),
            self.scale.horizontal.into(),
            self.scale.vertical.into(),
        );
        let turn = DMat3::from_rotation_z(self.yaw.into());
        let upright = turn * DMat3::from_diagonal(scale);
        if self.lean.tilt == 0.0 {
            return upright;
        }
        // Leaning towards azimuth a turns about the horizontal axis 90° counter-clockwise of it.
        let (sin, cos) = f64::from(self.lean.azimuth).sin_cos();
        DMat3::from_axis_angle(DVec3::new(-cos, sin, 0.0), self.lean.tilt.into()) * upright
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn placement() -> Placement {
        Placement {
            prototype: PrototypeId(0),
            position: DVec3::ZERO,
            yaw: 0.0,
            scale: Scale { horizontal: 1.0, vertical: 1.0 },
            lean: Lean::UPRIGHT,
        }
    }

    #[test]
    fn a_lean_of_30_degrees_to_the_east_moves_the_top_east() {
        let tilt = 30_f32.to_radians();
        let lean = Placement { lean: Lean { tilt, azimuth: 90_f32.to_radians() }, ..placement() };
        let top = lean.world_from_object() * DVec3::Z;
        assert!((top - DVec3::new(0.5, 0.0, 0.75_f64.sqrt())).length() < 1e-6, "{top}");
    }

    #[test]
    fn a_yaw_of_90_degrees_turns_east_to_north() {
        let turned = Placement {
            yaw: 90_f32.to_radians(),
            scale: Scale { horizontal: 2.0, vertical: 1.0 },
            ..placement()
        };
        let east = turned.world_from_object() * DVec3::X;
        assert!((east - DVec3::new(0.0, 2.0, 0.0)).length() < 1e-6, "{east}");
    }

    /// Sizes of the columns of a [`World`] for one instance, in bytes.
    #[test]
    fn instances_take_48_bytes_and_8_more_if_they_lean() {
        let sizes = [
            size_of::<SceneId>(),
            size_of::<PlantingId>(),
            size_of::<PrototypeId>(),
            size_of::<Position>(),
            size_of::<Yaw>(),
            size_of::<Scale>(),
        ];
        assert_eq!(sizes.iter().sum::<usize>(), 48);
        assert_eq!(size_of::<Lean>(), 8);
    }

    #[test]
    fn instances_keep_their_values_and_their_order_in_a_world() {
        let instances = || {
            (0..100_u16).map(|id| {
                let tilt = if id % 3 == 0 { 0.1 } else { 0.0 };
                let lean = Lean { tilt, azimuth: 20.0 * tilt };
                let placement = Placement { yaw: id.into(), lean, ..placement() };
                Instance {
                    id: SceneId(id.into()),
                    planting: PlantingId(u32::from(id) / 7),
                    placement,
                }
            })
        };
        let mut world = World::new();
        Instance::spawn(instances, &mut world);
        assert_eq!(Instance::in_order(&world), instances().collect::<Vec<_>>());
    }
}
