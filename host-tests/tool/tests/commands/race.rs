//! What palpate spends in the race, against the committed budgets. The peers are left out: they take minutes to
//! compile.

use palpate_tool::firmware::{Progress, WITH_FIRMWARE};
use palpate_tool::race::{self, Budget, Counted, Program, Scene, Spread, Task, Who, excesses};
use std::env;
use std::error::Error;

/// Valgrind and a program to count; `None`, said aloud, where valgrind is missing and nobody asked for a set-up.
fn program() -> Result<Option<Program>, Box<dyn Error>> {
    let progress = Progress::new();
    if env::var_os(WITH_FIRMWARE).is_none() && !race::is_set_up() {
        println!("left out: valgrind is missing (`cargo palpate test` installs it)");
        return Ok(None);
    }
    race::set_up(&progress)?;
    Ok(Some(Program::build(Who::Own, &progress)?))
}

#[test]
fn own_instructions_repeat_exactly_and_stay_within_their_budgets() -> Result<(), Box<dyn Error>> {
    // Other machines have other instructions.
    if !cfg!(target_arch = "x86_64") {
        println!("left out: the budgets are for x86-64");
        return Ok(());
    }
    let Some(program) = program()? else { return Ok(()) };
    let budgets = Budget::all()?;
    let scenes = [
        Scene::golden("table1c", Task::Cold, "table1c_near.csv")?,
        Scene::golden("table1c", Task::Track, "table1c_track.csv")?,
    ];
    for scene in scenes {
        let budgets: Vec<&Budget> = budgets.iter().filter(|budget| budget.is_for(&scene)).collect();
        let names: Vec<&str> = budgets.iter().map(|budget| budget.contestant.as_str()).collect();
        assert!(names.contains(&"palpate"), "no budget for {}", scene.title());
        let counted = program.count(&scene, &names)?;
        assert_eq!(counted, program.count(&scene, &names)?, "{}: counted twice, not equal", scene.title());
        for budget in budgets {
            let counted = counted.iter().find(|counted| counted.contestant == budget.contestant);
            let counted = counted.ok_or_else(|| format!("{} does not take part", budget.contestant))?;
            let Spread { median, worst, .. } = Spread::of(&counted.instructions).ok_or("nothing was counted")?;
            println!("{}, {}: median {median}, dearest {worst} instructions", scene.title(), budget.contestant);
            let excesses: Vec<String> = excesses(budget, &scene, counted).iter().map(ToString::to_string).collect();
            assert!(excesses.is_empty(), "{}", excesses.join("\n"));
        }
    }
    Ok(())
}

#[test]
fn four_per_cent_more_are_named_and_two_are_not() -> Result<(), Box<dyn Error>> {
    let scene = Scene::golden("table1c", Task::Track, "table1c_track.csv")?;
    let budgets = Budget::all()?;
    let budget = budgets.iter().find(|budget| budget.is_for(&scene)).ok_or("no budget")?;
    let grown = |percent: u64| Counted {
        contestant: "palpate".to_owned(),
        instructions: vec![budget.median * (100 + percent) / 100; 3],
    };
    let named: Vec<&str> = excesses(budget, &scene, &grown(4)).iter().map(|excess| excess.which).collect();
    assert_eq!(named, ["median"]);
    assert!(excesses(budget, &scene, &grown(2)).is_empty());
    Ok(())
}
