//! Boxes fall onto a floor: a world tells which begin to touch, and a ray asks what lies below.
//!
//! `cargo run --example falling_boxes`
use broadside::{Box2, Error, Filter, World};

fn main() -> Result<(), Error> {
    let names = ["floor", "crate", "barrel", "ball"];
    let mut boxes = [
        Box2::new([0.0, -1.0], [10.0, 0.0]),
        Box2::new([1.0, 1.0], [2.0, 2.0]),
        Box2::new([1.5, 4.0], [2.5, 5.0]),
        Box2::new([6.0, 3.0], [6.5, 3.5]),
    ];
    let mut filters = [Filter::default(); 4];
    filters[0].is_static = true;

    let mut world = World::new()?;
    let handles = world.add_with(&boxes, &filters, &[0, 1, 2, 3])?; // places in `names`
    let mut lies = [false; 4];
    for frame in 1..=10 {
        for (place, bounds) in boxes.iter_mut().enumerate().skip(1) {
            if !lies[place] {
                bounds.min[1] -= 0.5;
                bounds.max[1] -= 0.5;
                world.move_to(&handles[place..=place], &[*bounds])?;
            }
        }
        world.update()?;
        for pair in world.events().begun {
            let [a, b] = [world.user_data(pair.first)? as usize, world.user_data(pair.second)? as usize];
            println!("frame {frame}: {} and {} begin to touch", names[a], names[b]);
            lies[a.max(b)] = true;
        }
    }

    let bird = Box2::point([1.7, 9.0]);
    if let Some(hit) = world.query().first_hit(bird, [0.0, -1.0], f64::INFINITY)? {
        println!("below the bird, at a distance of {}: {}", hit.t_enter, names[world.user_data(hit.id)? as usize]);
    }
    Ok(())
}
