//! Facts about the schedule: its order, its thrift, and how it stops.

use super::*;

#[derive(Clone, PartialEq, Debug)]
struct Given(u32);

#[derive(Clone, PartialEq, Debug)]
struct Doubled(u32);

impl Product for Doubled {}

struct Double;

impl System for Double {
    type Product = Doubled;
    const NAME: &'static str = "double";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Doubled>) -> Result<(), Error> {
        for (entity, stated) in &mut world.query::<(Entity, &Given)>() {
            out.derive(entity, stated.clone(), |stated| Ok(Doubled(stated.0 * 2)))?;
        }
        Ok(())
    }

    fn plan(_: &World) -> Plan {
        Plan::absent("a test")
    }
}

fn job(name: &'static str, makes: ProductKey, reads: &'static [ProductKey]) -> Job {
    Job { name, makes, reads, ..Job::of::<Double>() }
}

/// Products that nothing makes.
#[derive(Clone)]
struct First;
#[derive(Clone)]
struct Second;
#[derive(Clone)]
struct Third;
impl Product for First {}
impl Product for Second {}
impl Product for Third {}

const FIRST: ProductKey = ProductKey::of::<First>();
const SECOND: ProductKey = ProductKey::of::<Second>();
const THIRD: ProductKey = ProductKey::of::<Third>();

#[test]
fn the_order_follows_from_who_makes_what() {
    let jobs = [
        job("cast", THIRD, &[SECOND]),
        job("relight", SECOND, &[FIRST]),
        job("classify", FIRST, &[]),
    ];
    let schedule = Schedule::new(&jobs).unwrap();
    let names: Vec<_> = schedule.waves().iter().flatten().map(|job| job.name).collect();
    assert_eq!(names, ["classify", "relight", "cast"]);
}

#[test]
fn two_makers_and_a_cycle_are_refused() {
    let twice = [job("a", FIRST, &[]), job("b", FIRST, &[])];
    let cycle = [job("a", FIRST, &[SECOND]), job("b", SECOND, &[FIRST])];
    assert!(
        Schedule::new(&twice).is_err_and(|e| e.to_string().contains("a and b both make First"))
    );
    assert!(Schedule::new(&cycle).is_err_and(|e| e.to_string().contains("wait for each other")));
}

/// Derives every entity twice.
struct Twice;

impl System for Twice {
    type Product = Doubled;
    const NAME: &'static str = "twice";
    const READS: &'static [ProductKey] = &[];

    fn run(world: &World, out: &mut Outbox<'_, Doubled>) -> Result<(), Error> {
        Double::run(world, out)?;
        Double::run(world, out)
    }

    fn plan(_: &World) -> Plan {
        Plan::absent("a test")
    }
}

#[test]
fn a_system_that_derives_an_entity_twice_is_refused() {
    let schedule = Schedule::new(&[Job::of::<Twice>()]).unwrap();
    let mut world = World::new();
    world.spawn((Given(4),));
    let refused = schedule.run(&mut world, &Watch::default()).unwrap_err();
    assert!(refused.to_string().contains("Doubled of one entity twice"), "{refused}");
}

#[test]
fn a_product_that_is_not_there_is_made_anew_and_one_that_was_put_back_is_kept() {
    let schedule = Schedule::new(&[Job::of::<Double>()]).unwrap();
    let (mut world, watch) = (World::new(), Watch::default());
    world.spawn((Given(4),));
    schedule.run(&mut world, &watch).unwrap();
    let restore = ProductKey::of::<Doubled>().hide(&mut world);
    assert!(world.query::<&Doubled>().iter().next().is_none());
    restore(&mut world);
    assert_eq!(schedule.run(&mut world, &watch).unwrap()[0].reused, 1);
    drop(ProductKey::of::<Doubled>().hide(&mut world));
    assert_eq!(schedule.run(&mut world, &watch).unwrap()[0].made, 1);
}

#[test]
fn equal_inputs_are_reused_changed_ones_made_and_what_is_not_asked_for_is_taken_off() {
    let schedule = Schedule::new(&[Job::of::<Double>()]).unwrap();
    let (mut world, watch) = (World::new(), Watch::default());
    let entity = world.spawn((Given(4),));
    let did = |world: &mut World| {
        let ran = &schedule.run(world, &watch).unwrap()[0];
        (ran.made, ran.reused)
    };
    assert_eq!(did(&mut world), (1, 0));
    assert_eq!(did(&mut world), (0, 1));
    world.insert_one(entity, Given(5)).unwrap();
    assert_eq!(did(&mut world), (1, 0));
    assert_eq!(*world.get::<&Doubled>(entity).unwrap(), Doubled(10));
    world.remove_one::<Given>(entity).unwrap();
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
