//! Facts about the schedule: its order, its thrift, and how it stops.

use super::*;

#[derive(Clone, PartialEq, Debug)]
struct Stated(u32);

#[derive(Clone, PartialEq, Debug)]
struct Doubled(u32);

impl Product for Doubled {
    const KIND: Kind = Kind::Gradient;
}

struct Double;

impl System for Double {
    type Product = Doubled;
    const NAME: &'static str = "double";
    const READS: &'static [Kind] = &[Kind::Scalars];

    fn run(world: &World, out: &mut Outbox<'_, Doubled>) -> Result<(), Error> {
        for (entity, stated) in &mut world.query::<(Entity, &Stated)>() {
            out.derive(entity, stated.clone(), |stated| Ok(Doubled(stated.0 * 2)))?;
        }
        Ok(())
    }

    fn plan(_: &World) -> Plan {
        Plan::absent("a test")
    }
}

fn job(name: &'static str, makes: Kind, reads: &'static [Kind]) -> Job {
    Job { name, makes, reads, ..Job::of::<Double>() }
}

#[test]
fn the_order_follows_from_who_makes_what() {
    let jobs = [
        job("cast", Kind::Samples, &[Kind::Gel, Kind::View]),
        job("relight", Kind::Gel, &[Kind::Opacity]),
        job("classify", Kind::Opacity, &[Kind::Scalars]),
    ];
    let schedule = Schedule::new(&jobs).unwrap();
    let names: Vec<_> = schedule.waves().iter().flatten().map(|job| job.name).collect();
    assert_eq!(names, ["classify", "relight", "cast"]);
}

#[test]
fn two_makers_and_a_cycle_are_refused() {
    let twice = [job("a", Kind::Gel, &[]), job("b", Kind::Gel, &[])];
    let cycle = [job("a", Kind::Gel, &[Kind::Opacity]), job("b", Kind::Opacity, &[Kind::Gel])];
    assert!(Schedule::new(&twice).is_err_and(|e| e.to_string().contains("both make")));
    assert!(Schedule::new(&cycle).is_err_and(|e| e.to_string().contains("wait for each other")));
}

#[test]
fn equal_inputs_are_reused_changed_ones_made_and_what_is_not_asked_for_is_taken_off() {
    let schedule = Schedule::new(&[Job::of::<Double>()]).unwrap();
    let (mut world, watch) = (World::new(), Watch::default());
    let entity = world.spawn((Stated(4),));
    let did = |world: &mut World| {
        let ran = &schedule.run(world, &watch).unwrap()[0];
        (ran.made, ran.reused)
    };
    assert_eq!(did(&mut world), (1, 0));
    assert_eq!(did(&mut world), (0, 1));
    world.insert_one(entity, Stated(5)).unwrap();
    assert_eq!(did(&mut world), (1, 0));
    assert_eq!(*world.get::<&Doubled>(entity).unwrap(), Doubled(10));
    world.remove_one::<Stated>(entity).unwrap();
    assert_eq!(did(&mut world), (0, 0));
    assert!(world.get::<&Doubled>(entity).is_err());
}

#[test]
fn a_stopped_schedule_makes_nothing() {
    let schedule = Schedule::new(&[Job::of::<Double>()]).unwrap();
    let (mut world, watch) = (World::new(), Watch::default());
    watch.stop();
    assert!(matches!(schedule.run(&mut world, &watch), Err(Error::Interrupted)));
}
